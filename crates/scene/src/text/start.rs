use crate::error::SceneError;
use crate::fault::Fault;
use crate::table::{TomlTable, as_f64};
use ::text::{StartError, TextModel, TextStart};
use toml::Spanned;
use toml::de::DeValue;

/// What a start gives: coordinates and rates, `None` for those that are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Given {
    /// The coordinates.
    pub q: Vec<Option<f64>>,
    /// Their rates.
    pub v: Vec<Option<f64>>,
}

impl Given {
    /// The number of that name: a coordinate, or a rate as `x'` or `x_dot`.
    pub(super) fn named(&mut self, name: &str, model: &TextModel) -> Option<&mut Option<f64>> {
        let place = |name: &str| model.coordinates().iter().position(|coordinate| coordinate.name == name);
        match name.strip_suffix('\'').or_else(|| name.strip_suffix("_dot")).and_then(place) {
            Some(i) => self.v.get_mut(i),
            None => self.q.get_mut(place(name)?),
        }
    }
}

/// Reads `[start]` of a system of text: coordinates by their names, rates as `"x'"` or `x_dot`, all of which may be left out.
pub(crate) fn read(root: &TomlTable<'_>, model: &TextModel) -> Result<(TextStart, Given), SceneError> {
    let names: Vec<&str> = model.coordinates().iter().map(|coordinate| coordinate.name.as_str()).collect();
    let rates: Vec<[String; 2]> = names.iter().map(|name| [format!("{name}'"), format!("{name}_dot")]).collect();
    let known: Vec<&str> = names.iter().copied().chain(rates.iter().flatten().map(String::as_str)).collect();
    let (mut q, mut v) = (vec![None; names.len()], vec![None; names.len()]);
    let mut header = root.header();
    if let Some(value) = root.get("start") {
        header = value.span();
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(root.wrong_type("start", value, "a table of coordinates and rates".to_owned()));
        };
        let table = root.inner("start".to_owned(), entries, value.span(), &known)?;
        for (i, name) in names.iter().enumerate() {
            q[i] = number(&table, name)?;
            let [primed, dotted] = &rates[i];
            let both = [number(&table, primed)?, number(&table, dotted)?];
            if let ([Some(_), Some(_)], Some(second)) = (both, table.get(dotted)) {
                let fault = Fault {
                    variant: SceneError::OutOfRange,
                    key: "",
                    problem: format!("is another spelling of `{primed}`, which is given already"),
                    found: None,
                    accepted: "one of the two spellings of a rate".to_owned(),
                    help: None,
                };
                return Err(root.document.fail(&second.span(), Some(table.path_of(dotted)), fault));
            }
            v[i] = both[0].or(both[1]);
        }
    }
    let start = model.start(&q, &v).map_err(|error| {
        // A wrong basis is not the fault of the start.
        let basis = match (&error, root.get("system").map(Spanned::get_ref)) {
            (StartError::Basis { .. }, Some(DeValue::Table(system))) => system.get("basis").map(Spanned::span),
            _ => None,
        };
        let (field, accepted) = match basis {
            Some(_) => ("system.basis", "vectors whose product with each row of the constraints vanishes"),
            None => (
                "start",
                "coordinates and rates at which all formulas are finite, near those that meet the constraints",
            ),
        };
        let fault = Fault {
            variant: SceneError::Formula,
            key: "",
            problem: if basis.is_some() { format!("is wrong: {error}") } else { format!("gives no state: {error}") },
            found: None,
            accepted: accepted.to_owned(),
            help: None,
        };
        root.document.fail(&basis.unwrap_or(header), Some(field.to_owned()), fault)
    })?;
    Ok((start, Given { q, v }))
}

/// The finite number of that name, if it is given.
fn number(table: &TomlTable<'_>, name: &str) -> Result<Option<f64>, SceneError> {
    let Some(value) = table.get(name) else { return Ok(None) };
    let accepted = || "a finite number".to_owned();
    let number = as_f64(value.get_ref()).ok_or_else(|| table.wrong_type(name, value, accepted()))?;
    if number.is_finite() {
        return Ok(Some(number));
    }
    let fault = Fault {
        variant: SceneError::OutOfRange,
        key: "",
        problem: "must be finite".to_owned(),
        found: Some(format!("{number:?}")),
        accepted: accepted(),
        help: None,
    };
    Err(table.document.fail(&value.span(), Some(table.path_of(name)), fault))
}
