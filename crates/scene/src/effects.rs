use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::suggest;
use crate::table::{Table, type_name};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The kinds of effects that a scene may name in this version.
pub const EFFECTS: &[&str] = &[];

/// Checks the entries of `[[effects]]`.
pub(crate) fn read(root: &Table<'_>) -> Result<(), SceneError> {
    let Some(value) = root.get("effects") else {
        return Ok(());
    };
    let DeValue::Array(entries) = value.get_ref() else {
        return Err(root.wrong_type("effects", value, "a list of tables, each headed `[[effects]]`".to_owned()));
    };
    for entry in entries {
        let DeValue::Table(table) = entry.get_ref() else {
            let accepted = "a table with a key `kind`".to_owned();
            let found = Some(type_name(entry.get_ref()).to_owned());
            let problem = "must hold tables";
            return Err(fail(&root.document, SceneError::WrongType, "effects", entry.span(), problem, found, accepted));
        };
        read_entry(&root.document, entry.span(), table)?;
    }
    Ok(())
}

/// Reads one effect: its `kind` says which other keys it has, so that is read first.
fn read_entry(document: &Document<'_>, header: Range<usize>, table: &DeTable<'_>) -> Result<(), SceneError> {
    let field = "effects.kind";
    let Some(kind) = table.get("kind") else {
        return Err(fail(document, SceneError::Missing, field, header, "is missing", None, accepted()));
    };
    let DeValue::String(name) = kind.get_ref() else {
        let found = Some(type_name(kind.get_ref()).to_owned());
        return Err(fail(document, SceneError::WrongType, field, kind.span(), "has the wrong type", found, accepted()));
    };
    Err(unknown(document, kind, name))
}

fn unknown(document: &Document<'_>, kind: &Spanned<DeValue<'_>>, name: &str) -> SceneError {
    let fault = Fault {
        variant: SceneError::UnknownName,
        key: "kind",
        problem: "is not an effect of this version".to_owned(),
        found: Some(format!("{:?}", crate::keys::abridged(name))),
        accepted: accepted(),
        help: suggest::nearest(name, EFFECTS.iter().copied()).map(suggest::did_you_mean),
    };
    document.fail(&kind.span(), Some("effects.kind".to_owned()), fault)
}

fn accepted() -> String {
    if EFFECTS.is_empty() {
        "no kind: this version knows no effects yet".to_owned()
    } else {
        format!("one of {}", suggest::list(EFFECTS))
    }
}

