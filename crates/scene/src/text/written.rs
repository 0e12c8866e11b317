use super::{AnyScene, TextScene};
use ::text::{Unit, Words};
use serde::{Serialize, Serializer};

/// A scene of a system of text as its file has it: plain values before the tables.
#[derive(Serialize)]
struct WrittenTextFile<'s> {
    title: &'s str,
    system: WrittenSystem<'s>,
    start: WrittenTable<'s, f64>,
    run: &'s crate::RunSettings,
}

#[derive(Serialize)]
struct WrittenSystem<'s> {
    lagrangian: &'s str,
    #[serde(skip_serializing_if = "WrittenRows::is_empty")]
    constraints: WrittenRows<'s>,
    #[serde(skip_serializing_if = "WrittenRows::is_empty")]
    positions: WrittenRows<'s>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    basis: &'s [Vec<String>],
    coordinates: WrittenTable<'s, &'s str>,
    parameters: WrittenTable<'s, f64>,
    #[serde(rename = "let")]
    abbreviations: WrittenTable<'s, &'s str>,
    forces: WrittenTable<'s, &'s str>,
    outputs: WrittenTable<'s, WrittenOutput<'s>>,
}

/// Constraints: a list, or a table if they have names.
#[derive(Serialize)]
#[serde(untagged)]
enum WrittenRows<'s> {
    Listed(&'s [String]),
    Named(WrittenTable<'s, &'s str>),
}

impl<'s> WrittenRows<'s> {
    fn of(names: &'s [String], formulas: &'s [String]) -> Self {
        if names.first().is_none_or(String::is_empty) {
            return Self::Listed(formulas);
        }
        let named = names.iter().zip(formulas).map(|(name, formula)| (name.as_str(), formula.as_str()));
        Self::Named(WrittenTable(named.collect()))
    }

    fn is_empty(&self) -> bool {
        matches!(self, Self::Listed([]))
    }
}

/// A table whose keys stay in their order.
struct WrittenTable<'s, T>(Vec<(&'s str, T)>);

impl<T: Serialize> Serialize for WrittenTable<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

fn formulas(pairs: &[(String, String)]) -> WrittenTable<'_, &str> {
    WrittenTable(pairs.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect())
}

/// A formula, with its unit if it has one.
#[derive(Serialize)]
#[serde(untagged)]
enum WrittenOutput<'s> {
    Bare(&'s str),
    InUnit { formula: &'s str, unit: &'s str },
}

fn outputs(words: &Words) -> WrittenTable<'_, WrittenOutput<'_>> {
    // Tables would be written behind formulas, in another order.
    let in_units = words.output_units.iter().any(|unit| !unit.is_empty());
    let written = words.outputs.iter().enumerate().map(|(k, (name, formula))| {
        let output = match words.output_units.get(k) {
            Some(unit) if in_units => WrittenOutput::InUnit { formula, unit },
            _ => WrittenOutput::Bare(formula),
        };
        (name.as_str(), output)
    });
    WrittenTable(written.collect())
}

fn unit(unit: &Unit) -> &str {
    if *unit == Unit::Angle { "angle" } else { unit.name() }
}

impl TextScene {
    /// The scene as a file that reads back as the same scene, its numbers as they were used.
    ///
    /// # Errors
    /// [`toml::ser::Error`], which a scene of finite numbers does not give.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let Self { title, words, start, run, .. } = self;
        let names: Vec<&str> = words.coordinates.iter().map(|(name, _)| name.as_str()).collect();
        let rates: Vec<String> = names.iter().map(|name| format!("{name}'")).collect();
        let state = names.iter().copied().chain(rates.iter().map(String::as_str));
        toml::to_string(&WrittenTextFile {
            title,
            system: WrittenSystem {
                lagrangian: &words.lagrangian,
                constraints: WrittenRows::of(&words.rows, &words.constraints),
                positions: WrittenRows::of(
                    words.rows.get(words.constraints.len()..).unwrap_or_default(),
                    &words.positions,
                ),
                basis: &words.basis,
                coordinates: WrittenTable(
                    words.coordinates.iter().map(|(name, of)| (name.as_str(), unit(of))).collect(),
                ),
                parameters: WrittenTable(
                    words.parameters.iter().map(|(name, value)| (name.as_str(), *value)).collect(),
                ),
                abbreviations: formulas(&words.abbreviations),
                forces: formulas(&words.forces),
                outputs: outputs(words),
            },
            start: WrittenTable(state.zip(start.q.iter().chain(&start.v).copied()).collect()),
            run,
        })
    }
}

impl AnyScene {
    /// The scene as a file, as [`Scene::to_toml`](crate::Scene::to_toml).
    ///
    /// # Errors
    /// As there.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        match self {
            Self::Sleigh(scene) => scene.to_toml(),
            Self::Text(scene) => scene.to_toml(),
        }
    }
}
