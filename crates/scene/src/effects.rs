use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::finding::Finding;
use crate::keys::abridged;
use crate::suggest;
use crate::table::{Table, type_name};
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The kinds of effects that a scene may name in this version.
pub const EFFECTS: &[&str] = &[];

/// Checks the entries of `[[effects]]`.
pub(crate) fn read(root: &Table<'_>) -> Result<(), SceneError> {
    let Some(value) = root.get("effects") else {
        return Ok(());
    };
    let accepted = "a list of tables, each headed `[[effects]]`";
    let DeValue::Array(entries) = value.get_ref() else {
        return Err(root.wrong_type("effects", value, accepted.to_owned()));
    };
    for entry in entries {
        let DeValue::Table(table) = entry.get_ref() else {
            return Err(root.wrong_type("effects", entry, accepted.to_owned()));
        };
        read_entry(&root.document, entry.span(), table)?;
    }
    Ok(())
}

/// Reads one effect: its `kind` says which other keys it has, so that is read first.
fn read_entry(document: &Document<'_>, header: Range<usize>, table: &DeTable<'_>) -> Result<(), SceneError> {
    let Some(kind) = table.get("kind") else {
        return Err(fail(document, &header, SceneError::Missing, "is missing", None, None));
    };
    let DeValue::String(name) = kind.get_ref() else {
        let found = type_name(kind.get_ref()).to_owned();
        return Err(fail(document, &kind.span(), SceneError::WrongType, "has the wrong type", Some(found), None));
    };
    // No kind is known yet. The other keys of one that is known are those of a plain struct that refuses unknown
    // fields, deserialised from the rest of the table; the errors of serde carry the span to mark.
    let found = format!("{:?}", abridged(name));
    let help = suggest::nearest(name, EFFECTS.iter().copied()).map(suggest::did_you_mean);
    let problem = "names no effect of this version";
    Err(fail(document, &kind.span(), SceneError::UnknownName, problem, Some(found), help))
}

fn fail(
    document: &Document<'_>,
    span: &Range<usize>,
    variant: fn(Box<Finding>) -> SceneError,
    problem: &str,
    found: Option<String>,
    help: Option<String>,
) -> SceneError {
    let accepted = if EFFECTS.is_empty() {
        "no kind: this version knows no effects yet".to_owned()
    } else {
        format!("one of {}", suggest::list(EFFECTS))
    };
    let fault = Fault { variant, key: "kind", problem: problem.to_owned(), found, accepted, help };
    document.fail(span, Some("effects.kind".to_owned()), fault)
}
