use super::faults::TextPlaces;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::table::{TomlTable, as_f64};
use ::text::{Entry, Unit, Words};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys of `[system]`.
const KEYS: &[&str] = &[
    "coordinates",
    "parameters",
    "tables",
    "let",
    "lagrangian",
    "constraints",
    "positions",
    "forces",
    "basis",
    "outputs",
];

type Value<'s> = Spanned<DeValue<'s>>;

const FORMULA: &str = "a formula in quotes";

/// Reads `[system]`: its texts, and where they stand.
pub(crate) fn read(root: &TomlTable<'_>) -> Result<(Words, TextPlaces), SceneError> {
    let system = root.table_of("system", KEYS)?;
    let mut words = Words::default();
    let mut places = TextPlaces::default();
    places.add(Entry::System, "system".to_owned(), system.header());

    let accepted = "a table of units, as { x = \"m\", theta = \"angle\" }, in the order of the coordinates";
    let Some(coordinates) = entries(&system, "coordinates", accepted)? else {
        return Err(system.missing("coordinates", accepted.to_owned()));
    };
    for (k, (name, field, value)) in coordinates.into_iter().enumerate() {
        let unit = text(&system, &field, value, "a unit in quotes; `angle` is in rad, with the period of a turn")?;
        places.add(Entry::Coordinate(k), field, value.span());
        words.coordinates.push((name, if unit == "angle" { Unit::Angle } else { Unit::Other(unit) }));
    }
    let parameters = entries(&system, "parameters", "a table of numbers, as { m = 1.0 }")?.unwrap_or_default();
    for (k, (name, field, value)) in parameters.into_iter().enumerate() {
        let number = as_f64(value.get_ref())
            .ok_or_else(|| system.wrong_type(bare(&field), value, "a finite number".to_owned()))?;
        places.add(Entry::Parameter(k), field, value.span());
        words.parameters.push((name, number));
    }
    let accepted =
        "a table of tables, as { push = { times = [0.0, 1.0], values = [0.0, 2.0], interpolation = \"linear\" } }";
    for (k, (name, field, value)) in entries(&system, "tables", accepted)?.unwrap_or_default().into_iter().enumerate() {
        let DeValue::Table(points) = value.get_ref() else {
            return Err(system.wrong_type(bare(&field), value, accepted.to_owned()));
        };
        let keys = &["times", "values", "file", "columns", "interpolation"];
        let formula = system.inner(field.clone(), points, value.span(), keys)?.formula_of_points()?;
        places.add(Entry::Abbreviation(k), field, value.span());
        words.abbreviations.push((name, formula));
    }
    let accepted = "a table of formulas, as { c = \"cos(theta)\" }";
    let tables = words.abbreviations.len();
    words.abbreviations.extend(named(&system, &mut places, "let", accepted, |k| Entry::Abbreviation(tables + k))?);
    let Some(lagrangian) = system.get("lagrangian") else {
        return Err(system.missing("lagrangian", FORMULA.to_owned()));
    };
    words.lagrangian = text(&system, "system.lagrangian", lagrangian, FORMULA)?;
    places.add(Entry::Lagrangian, "system.lagrangian".to_owned(), lagrangian.span());
    (words.rows, words.constraints) = rows(&system, &mut places, "constraints", Entry::Constraint)?;
    let (names, positions) = rows(&system, &mut places, "positions", Entry::Position)?;
    words.positions = positions;
    words.rows.extend(names);
    let accepted = "a table of formulas by the names of coordinates, as { theta = \"-0.1*theta'\" }";
    words.forces = named(&system, &mut places, "forces", accepted, Entry::Force)?;
    if let Some(value) = system.get("basis") {
        places.add(Entry::Basis, "system.basis".to_owned(), value.span());
        for (k, vector) in
            array(&system, "basis", value, "a list of vectors, each a list of formulas")?.iter().enumerate()
        {
            places.add(Entry::Vector(k), "system.basis".to_owned(), vector.span());
            let mut components = Vec::new();
            for (i, component) in array(&system, "basis", vector, "a list of formulas")?.iter().enumerate() {
                places.add(Entry::Component(k, i), "system.basis".to_owned(), component.span());
                components.push(text(&system, "system.basis", component, FORMULA)?);
            }
            words.basis.push(components);
        }
    }
    outputs(&system, &mut places, &mut words)?;
    Ok((words, places))
}

/// The last part of a path.
fn bare(field: &str) -> &str {
    field.strip_prefix("system.").unwrap_or(field)
}

/// A string.
fn text(system: &TomlTable<'_>, field: &str, value: &Value<'_>, accepted: &str) -> Result<String, SceneError> {
    match value.get_ref() {
        DeValue::String(text) => Ok(text.to_string()),
        _ => Err(system.wrong_type(bare(field), value, accepted.to_owned())),
    }
}

fn array<'s>(
    system: &TomlTable<'_>,
    key: &str,
    value: &'s Value<'s>,
    accepted: &str,
) -> Result<&'s [Value<'s>], SceneError> {
    match value.get_ref() {
        DeValue::Array(entries) => Ok(entries),
        _ => Err(system.wrong_type(key, value, accepted.to_owned())),
    }
}

/// The outputs: formulas, or tables of a formula and its unit.
fn outputs(system: &TomlTable<'_>, places: &mut TextPlaces, words: &mut Words) -> Result<(), SceneError> {
    const TABLE: &str = "a table of formulas, as { speed = \"x'*cos(theta) + y'*sin(theta)\" }";
    const ACCEPTED: &str = "a formula in quotes, or { formula = \"..\", unit = \"m/s\" }";
    for (k, (name, field, value)) in entries(system, "outputs", TABLE)?.unwrap_or_default().into_iter().enumerate() {
        places.add(Entry::Output(k), field.clone(), value.span());
        let (formula, unit) = match value.get_ref() {
            DeValue::Table(table) => {
                let output = system.inner(field, table, value.span(), &["formula", "unit"])?;
                let formula = output.text("formula", FORMULA)?;
                let formula = formula.ok_or_else(|| output.missing("formula", FORMULA.to_owned()))?;
                let unit = output.text("unit", "a unit in quotes")?.unwrap_or_default();
                (formula.to_owned(), unit.to_owned())
            }
            _ => (text(system, &field, value, ACCEPTED)?, String::new()),
        };
        words.outputs.push((name, formula));
        words.output_units.push(unit);
    }
    Ok(())
}

/// The names and the formulas of constraints: a list of formulas, or a table of formulas by their names.
fn rows(
    system: &TomlTable<'_>,
    places: &mut TextPlaces,
    key: &'static str,
    entry: fn(usize) -> Entry,
) -> Result<(Vec<String>, Vec<String>), SceneError> {
    const ACCEPTED: &str = "a list of formulas in quotes, or a table of formulas by names";
    let Some(value) = system.get(key) else { return Ok((Vec::new(), Vec::new())) };
    if matches!(value.get_ref(), DeValue::Table(_)) {
        return Ok(named(system, places, key, ACCEPTED, entry)?.into_iter().unzip());
    }
    let formulas = array(system, key, value, ACCEPTED)?.iter().enumerate().map(|(k, formula)| {
        places.add(entry(k), format!("system.{key}"), formula.span());
        Ok((String::new(), text(system, key, formula, FORMULA)?))
    });
    Ok(formulas.collect::<Result<Vec<_>, SceneError>>()?.into_iter().unzip())
}

/// The entries of a table in the order of the text, with their paths.
type Entries<'s> = Vec<(String, String, &'s Value<'s>)>;

fn entries<'s>(system: &TomlTable<'s>, key: &'static str, accepted: &str) -> Result<Option<Entries<'s>>, SceneError> {
    let Some(value) = system.get(key) else { return Ok(None) };
    let DeValue::Table(table) = value.get_ref() else {
        return Err(system.wrong_type(key, value, accepted.to_owned()));
    };
    let table: &DeTable<'_> = table;
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let inner = system.unchecked(format!("system.{key}"), table, value.span());
    Ok(Some(
        entries
            .into_iter()
            .map(|(name, value)| (name.get_ref().to_string(), inner.path_of(name.get_ref()), value))
            .collect(),
    ))
}

/// A table of formulas.
fn named(
    system: &TomlTable<'_>,
    places: &mut TextPlaces,
    key: &'static str,
    accepted: &str,
    entry: impl Fn(usize) -> Entry,
) -> Result<Vec<(String, String)>, SceneError> {
    let mut formulas = Vec::new();
    for (k, (name, field, value)) in entries(system, key, accepted)?.unwrap_or_default().into_iter().enumerate() {
        let formula = text(system, &field, value, FORMULA)?;
        places.add(entry(k), field, value.span());
        formulas.push((name, formula));
    }
    Ok(formulas)
}

impl<'s> TomlTable<'s> {
    /// The document of a system of text.
    pub(crate) fn of_system(
        document: crate::document::Document<'s>,
        entries: &'s DeTable<'s>,
    ) -> Result<Self, SceneError> {
        for (key, problem, help) in [
            ("sleigh", "a scene is a sleigh or a system of text, not both", "leave out `[sleigh]` or `[system]`"),
            ("effects", "effects act on a sleigh", "add potentials to `lagrangian`, and forces to `forces`"),
        ] {
            if let Some(value) = entries.get(key) {
                let fault = Fault {
                    variant: SceneError::UnknownKey,
                    key: "",
                    problem: format!("does not go with `[system]`: {problem}"),
                    found: None,
                    accepted: "`title`, `[system]`, `[start]` and `[run]`".to_owned(),
                    help: Some(help.to_owned()),
                };
                return Err(document.fail(&value.span(), Some(key.to_owned()), fault));
            }
        }
        Self::whole(document, entries).with_known_keys(&["title", "system", "start", "run"])
    }

    /// The required table of that name, with these keys and no others.
    fn table_of(&self, key: &'static str, known: &[&str]) -> Result<Self, SceneError> {
        let accepted = || format!("the table `[{key}]` with the keys {}", crate::suggest::list(known));
        let value = self.get(key).ok_or_else(|| self.missing(key, accepted()))?;
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(self.wrong_type(key, value, accepted()));
        };
        self.inner(key.to_owned(), entries, value.span(), known)
    }
}
