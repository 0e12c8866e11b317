//! The values of effects: points, lists, paths.

use crate::error::SceneError;
use crate::fault::Fault;
use crate::quantity::KeyQuantity;
use crate::table::{TomlTable, as_f64};
use sleigh::ClosedPath;
use std::ops::Range;
use toml::Spanned;
use toml::de::DeValue;

const RADIUS: KeyQuantity = KeyQuantity::positive("radius", "m");
const CENTER: KeyQuantity = KeyQuantity::finite("center", "m");
const PERIOD: KeyQuantity = KeyQuantity::positive("period", "s");

impl<'s> TomlTable<'s> {
    /// A list of numbers, each within the range of the quantity, if the table has it.
    pub(crate) fn numbers(&self, quantity: &KeyQuantity) -> Result<Option<Vec<f64>>, SceneError> {
        self.get(quantity.key).map(|value| self.list(quantity, value)).transpose()
    }

    /// As [`numbers`](Self::numbers); a single number counts as a list of one.
    pub(crate) fn number_or_numbers(&self, quantity: &KeyQuantity) -> Result<Option<Vec<f64>>, SceneError> {
        let Some(value) = self.get(quantity.key) else { return Ok(None) };
        match as_f64(value.get_ref()) {
            Some(_) => Ok(self.number(quantity)?.map(|number| vec![number])),
            None => self.list(quantity, value).map(Some),
        }
    }

    fn list(&self, quantity: &KeyQuantity, value: &Spanned<DeValue<'_>>) -> Result<Vec<f64>, SceneError> {
        let accepted = || format!("a list of numbers, each {}", quantity.accepted());
        let DeValue::Array(entries) = value.get_ref() else {
            return Err(self.wrong_type(quantity.key, value, accepted()));
        };
        let number = |entry: &Spanned<DeValue<'_>>| {
            let number = as_f64(entry.get_ref()).ok_or_else(|| self.wrong_type(quantity.key, entry, accepted()))?;
            quantity.check(number).map_err(|fault| self.fail_at(entry.span(), fault))?;
            Ok(number)
        };
        entries.iter().map(number).collect()
    }

    /// A pair of numbers, if the table has it.
    pub(crate) fn pair(&self, quantity: &KeyQuantity) -> Result<Option<[f64; 2]>, SceneError> {
        let Some(value) = self.get(quantity.key) else { return Ok(None) };
        let list = self.list(quantity, value)?;
        let pair = <[f64; 2]>::try_from(list.as_slice());
        pair.map(Some).map_err(|_| self.wrong_length(quantity, list.len(), value.span()))
    }

    /// A pair of numbers.
    pub(crate) fn required_pair(&self, quantity: &KeyQuantity) -> Result<[f64; 2], SceneError> {
        self.pair(quantity)?.ok_or_else(|| self.missing(quantity.key, two(quantity)))
    }

    fn wrong_length(&self, quantity: &KeyQuantity, found: usize, span: Range<usize>) -> SceneError {
        let fault = Fault::new(SceneError::OutOfRange, quantity.key, "has the wrong length", two(quantity))
            .found(format!("a list of {found}"));
        self.fail_at(span, fault)
    }

    /// The value of `key` as a table with these keys.
    pub(crate) fn nested(
        &self,
        key: &str,
        known: &[&str],
        accepted: impl Fn() -> String,
    ) -> Result<Option<Self>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(self.wrong_type(key, value, accepted()));
        };
        self.inner(self.path_of(key), entries, value.span(), known).map(Some)
    }

    /// The entries of a list of tables, whatever their keys; none where the table has no such list. Where there are several the path of
    /// each has its number, from 0 as in `--set`.
    pub(crate) fn entries_of(&self, key: &str, accepted: &str) -> Result<Vec<Self>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(Vec::new()) };
        let DeValue::Array(entries) = value.get_ref() else {
            return Err(self.wrong_type(key, value, accepted.to_owned()));
        };
        let path = |number: usize| match entries.len() {
            1 => self.path_of(key),
            _ => format!("{}[{number}]", self.path_of(key)),
        };
        let table = |(number, entry): (usize, &'s Spanned<DeValue<'s>>)| match entry.get_ref() {
            DeValue::Table(table) => Ok(self.unchecked(path(number), table, entry.span())),
            _ => Err(self.wrong_type(key, entry, accepted.to_owned())),
        };
        entries.iter().enumerate().map(table).collect()
    }

    /// The value of `key` as a list of tables with these keys.
    pub(crate) fn tables(&self, key: &'static str, known: &[&str], accepted: &str) -> Result<Vec<Self>, SceneError> {
        if self.get(key).is_none() {
            return Err(self.missing(key, accepted.to_owned()));
        }
        self.entries_of(key, accepted)?.into_iter().map(|table| table.with_known_keys(known)).collect()
    }

    /// A closed path.
    pub(crate) fn path(&self, key: &'static str) -> Result<ClosedPath, SceneError> {
        let accepted = || {
            "`{circle = {radius, center}, period}` or `{polygon = [[x, y], ..], period}`, lengths in m and the period in s"
                .to_owned()
        };
        let table = self.nested(key, &["circle", "polygon", "period"], accepted)?;
        let table = table.ok_or_else(|| self.missing(key, accepted()))?;
        let period = table.required(&PERIOD)?;
        let path = match (table.nested("circle", &["radius", "center"], accepted)?, table.get("polygon")) {
            (Some(circle), None) => {
                let center = circle.pair(&CENTER)?.unwrap_or([0.0; 2]);
                ClosedPath::circle(circle.required(&RADIUS)?, center, period)
            }
            (None, Some(value)) => ClosedPath::polygon(table.vertices(value)?, period),
            (Some(_), Some(_)) => return Err(table.wrong("polygon", "does not go with `circle`", accepted())),
            (None, None) => return Err(table.missing("circle", accepted())),
        };
        path.map_err(|error| table.wrong("polygon", &error.to_string(), accepted()))
    }

    fn vertices(&self, value: &Spanned<DeValue<'_>>) -> Result<Vec<[f64; 2]>, SceneError> {
        const VERTEX: KeyQuantity = KeyQuantity::finite("polygon", "m");
        let DeValue::Array(entries) = value.get_ref() else {
            return Err(self.wrong_type("polygon", value, format!("a list of vertices, each {}", two(&VERTEX))));
        };
        let vertex = |entry: &Spanned<DeValue<'_>>| {
            let list = self.list(&VERTEX, entry)?;
            <[f64; 2]>::try_from(list.as_slice()).map_err(|_| self.wrong_length(&VERTEX, list.len(), entry.span()))
        };
        entries.iter().map(vertex).collect()
    }

    /// The error for a value of the right type that makes no sense for its key.
    pub(crate) fn wrong(&self, key: &'static str, problem: &str, accepted: String) -> SceneError {
        let problem = problem.to_owned();
        self.fail(Fault::new(SceneError::OutOfRange, key, problem, accepted))
    }
}

fn two(quantity: &KeyQuantity) -> String {
    format!("a list of two numbers, in {}", quantity.unit)
}
