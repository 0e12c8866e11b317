use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::keys;
use crate::quantity::KeyQuantity;
use crate::suggest;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// One table of a scene, read key by key.
#[derive(Debug, Clone)]
pub(crate) struct TomlTable<'s> {
    pub(crate) document: Document<'s>,
    /// The path of the table, empty for the document itself.
    path: String,
    entries: &'s DeTable<'s>,
    /// Where the table is announced: what an error about a missing key points to.
    header: (usize, usize),
}

impl<'s> TomlTable<'s> {
    /// The document itself, whose keys are all known.
    pub(crate) fn root(document: Document<'s>, entries: &'s DeTable<'s>) -> Result<Self, SceneError> {
        Self::whole(document, entries).with_known_keys(keys::of(""))
    }

    /// The document itself, whatever its keys.
    pub(crate) fn whole(document: Document<'s>, entries: &'s DeTable<'s>) -> Self {
        Self { document, path: String::new(), entries, header: (0, 0) }
    }

    /// The required table `key`, whose keys are all known.
    pub(crate) fn table(&self, key: &'static str) -> Result<Self, SceneError> {
        let accepted = || format!("the table `[{key}]` with the keys {}", suggest::list(keys::of(key)));
        let value = self.get(key).ok_or_else(|| self.missing(key, accepted()))?;
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(self.wrong_type(key, value, accepted()));
        };
        self.inner(key.to_owned(), entries, value.span(), keys::of(key))
    }

    /// A table inside this one, with these keys and no others.
    pub(crate) fn inner(
        &self,
        path: String,
        entries: &'s DeTable<'s>,
        span: Range<usize>,
        known: &[&str],
    ) -> Result<Self, SceneError> {
        self.unchecked(path, entries, span).with_known_keys(known)
    }

    /// This table under another path.
    pub(crate) fn named(self, path: String) -> Self {
        Self { path, ..self }
    }

    /// A table inside this one, whatever its keys.
    pub(crate) fn unchecked(&self, path: String, entries: &'s DeTable<'s>, span: Range<usize>) -> Self {
        Self { document: self.document, path, entries, header: (span.start, span.end) }
    }

    /// Refuses keys that the table does not have, the first in the text before the others.
    pub(crate) fn with_known_keys(self, known: &[&str]) -> Result<Self, SceneError> {
        self.with_keys_of("a scene", known)
    }

    /// Refuses keys other than `known`, in a file of this kind.
    pub(crate) fn with_keys_of(self, kind: &str, known: &[&str]) -> Result<Self, SceneError> {
        let unknown = self.entries.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else {
            return Ok(self);
        };
        let name: &str = key.get_ref();
        // An effect shares keys with the other tables.
        let home = keys::home(name)
            .filter(|home| !self.path.starts_with("effects") && kind == "a scene" && *home != self.path);
        let help = match (home, suggest::nearest(name, known.iter().copied())) {
            (Some(""), _) if name == "title" => Some("`title` belongs at the top, before the first table".to_owned()),
            (Some(""), _) if name == "effects" => Some("effects are headed `[[effects]]`".to_owned()),
            (Some(""), _) => Some(format!("`{name}` is a table of its own, headed `[{name}]`")),
            (Some(table), _) => Some(format!("`{name}` belongs in the table `[{table}]`")),
            (None, Some(near)) => Some(suggest::did_you_mean(near)),
            (None, None) => None,
        };
        let fault =
            Fault::new(SceneError::UnknownKey, "", format!("is not a key of {kind}"), suggest::list(known)).help(help);
        Err(self.document.fail(&key.span(), Some(keys::path(&self.path, name)), fault))
    }

    /// The value of `key`, if the table has it.
    pub(crate) fn get(&self, key: &str) -> Option<&'s Spanned<DeValue<'s>>> {
        self.entries.get(key)
    }

    /// The number `quantity`, within its range, if the table has it.
    pub(crate) fn number(&self, quantity: &KeyQuantity) -> Result<Option<f64>, SceneError> {
        let Some(value) = self.get(quantity.key) else {
            return Ok(None);
        };
        let number =
            as_f64(value.get_ref()).ok_or_else(|| self.wrong_type(quantity.key, value, quantity.accepted()))?;
        quantity.check(number).map_err(|fault| self.fail(fault))?;
        Ok(Some(number))
    }

    /// The number `quantity`, within its range.
    pub(crate) fn required(&self, quantity: &KeyQuantity) -> Result<f64, SceneError> {
        self.number(quantity)?.ok_or_else(|| self.missing(quantity.key, quantity.accepted()))
    }

    /// The string `key`, if the table has it.
    pub(crate) fn text(&self, key: &'static str, accepted: &str) -> Result<Option<&'s str>, SceneError> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => match value.get_ref() {
                DeValue::String(text) => Ok(Some(text)),
                _ => Err(self.wrong_type(key, value, accepted.to_owned())),
            },
        }
    }

    /// The whole number `key`, 0 or more, if the table has it.
    pub(crate) fn whole_number(&self, key: &'static str) -> Result<Option<u64>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let whole = value.get_ref().as_integer().and_then(|n| u64::from_str_radix(n.as_str(), n.radix()).ok());
        let accepted = || "a whole number from 0 on, without a point or an exponent".to_owned();
        whole.map(Some).ok_or_else(|| self.wrong(key, "is not a whole number from 0 on", accepted()))
    }

    /// The truth value `key`; false where the table does not have it.
    pub(crate) fn truth(&self, key: &'static str) -> Result<bool, SceneError> {
        let Some(value) = self.get(key) else { return Ok(false) };
        value.get_ref().as_bool().ok_or_else(|| self.wrong_type(key, value, "true or false".to_owned()))
    }

    /// The table `key`, whatever its keys, if this one has it.
    pub(crate) fn section(&self, key: &'static str) -> Result<Option<Self>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::Table(entries) => Ok(Some(self.unchecked(key.to_owned(), entries, value.span()))),
            _ => Err(self.wrong_type(key, value, format!("the table `[{key}]`"))),
        }
    }

    /// The fault as an error at the value of its key, or at the header of the table when that has no such key.
    pub(crate) fn fail(&self, mut fault: Fault) -> SceneError {
        let span = self.get(fault.key).map(Spanned::span);
        if let Some(span) = &span {
            // As it is written, not as it was read: 1e999 rather than inf.
            fault.found = Some(keys::abridged(&self.document.text[span.clone()]));
        }
        self.document.fail(&span.unwrap_or(self.header()), Some(keys::path(&self.path, fault.key)), fault)
    }

    /// The fault as an error at that place.
    pub(crate) fn fail_at(&self, span: Range<usize>, mut fault: Fault) -> SceneError {
        fault.found = fault.found.or_else(|| Some(keys::abridged(&self.document.text[span.clone()])));
        self.document.fail(&span, Some(keys::path(&self.path, fault.key)), fault)
    }

    /// The error of a key that is not there.
    pub(crate) fn missing(&self, key: &'static str, accepted: String) -> SceneError {
        let problem = "is missing".to_owned();
        self.fail(Fault::new(SceneError::Missing, key, problem, accepted))
    }

    /// The error of a value whose type is not the accepted one.
    pub(crate) fn wrong_type(&self, key: &str, value: &Spanned<DeValue<'_>>, accepted: String) -> SceneError {
        let fault = Fault::new(SceneError::WrongType, "", "has the wrong type", accepted)
            .found(type_name(value.get_ref()).to_owned());
        self.document.fail(&value.span(), Some(keys::path(&self.path, key)), fault)
    }

    /// The path of a key of this table.
    pub(crate) fn path_of(&self, key: &str) -> String {
        keys::path(&self.path, key)
    }

    /// Where the table is announced.
    pub(crate) fn header(&self) -> Range<usize> {
        self.header.0..self.header.1
    }
}

/// An integer or a float as the nearest `f64`; infinite when there is none, `None` for other types.
pub(crate) fn as_f64(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => Some(float.as_str().parse().unwrap_or(f64::NAN)),
        // Read as a float, so that an integer may have more digits than any integer type.
        DeValue::Integer(integer) if integer.radix() == 10 => Some(integer.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Integer(integer) => Some(match u128::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(number) => number as f64,
            Err(_) => f64::INFINITY,
        }),
        _ => None,
    }
}

/// The type of a value, with its article.
pub(crate) fn type_name(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "a truth value",
        DeValue::Datetime(_) => "a date or time",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
