//! The keys of effects, with their types and units: from the schema of scenes, which the tests hold against the program.

use scene::EFFECTS;
use serde_json::{Value, json};
use std::fmt::Write;

/// A key of an effect.
struct Key {
    name: &'static str,
    kind: String,
    unit: Option<String>,
    meaning: String,
    required: bool,
    default: Value,
}

/// The keys of a kind of effect.
fn keys(kind: &str) -> Vec<Key> {
    let schema: Value = serde_json::from_str(scene::SCHEMA).unwrap_or_default();
    let definition = &schema["$defs"][kind];
    let names = EFFECTS.iter().find(|info| info.name == kind).map_or(&[][..], |info| info.keys);
    let key = |name: &&'static str| {
        let property = &definition["properties"][name];
        let said = property["description"].as_str().unwrap_or_default();
        let (meaning, unit) =
            match said.rsplit_once(" (").and_then(|(said, rest)| Some((said, rest.split_once(')')?.0))) {
                Some((said, unit)) => (said, Some(unit.to_owned())),
                None => (said, None),
            };
        let required = definition["required"].as_array().is_some_and(|all| all.iter().any(|one| one == name));
        let default = property["default"].clone();
        Key { name, kind: type_of(property), unit, meaning: meaning.to_owned(), required, default }
    };
    names.iter().map(key).collect()
}

/// The accepted values of a key, in words.
fn type_of(property: &Value) -> String {
    let number = |limits: &Value| match (limits["exclusiveMinimum"].as_f64(), limits["minimum"].as_f64()) {
        (Some(least), _) => format!("number > {least}"),
        (_, Some(least)) => format!("number >= {least}"),
        _ => "number".to_owned(),
    };
    match property["$ref"].as_str().and_then(|name| name.strip_prefix("#/$defs/")) {
        Some("pair") => "[number, number]".to_owned(),
        Some("function" | "place") => "number or function of time".to_owned(),
        Some("each") => "number, or a list".to_owned(),
        Some("positive_each") => "number > 0, or a list".to_owned(),
        Some(other) => other.to_owned(),
        None => match property["items"]["properties"].as_object() {
            Some(keys) => format!("list of {{{}}}", keys.keys().map(String::as_str).collect::<Vec<_>>().join(", ")),
            None => number(property),
        },
    }
}

/// For programs: an object for each key.
pub(crate) fn json(kind: &str) -> Value {
    let one = |key: Key| {
        let mut object = json!({"name": key.name, "type": key.kind, "unit": key.unit, "required": key.required});
        if !key.default.is_null() {
            object["default"] = key.default;
        }
        object["summary"] = json!(key.meaning);
        object
    };
    keys(kind).into_iter().map(one).collect()
}

/// For a person: the effects, and below each its keys.
pub(crate) fn text() -> String {
    let mut text = String::new();
    for info in EFFECTS {
        let _ = writeln!(text, "{}: {}", info.name, info.summary);
        for key in keys(info.name) {
            let unit = key.unit.as_ref().map_or_else(String::new, |unit| format!("  {unit}"));
            let needed = if key.required { "required".to_owned() } else { default(&key.default) };
            let said = if key.meaning.is_empty() { String::new() } else { format!("; {}", key.meaning) };
            let _ = writeln!(text, "    {:<12}{}{unit}, {needed}{said}", key.name, key.kind);
        }
    }
    text
}

fn default(value: &Value) -> String {
    if value.is_null() { "optional".to_owned() } else { format!("{value} when left out") }
}
