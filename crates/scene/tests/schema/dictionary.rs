//! tests/fuzz/scene.dict, the words from which the fuzzer makes scenes: those of the schema.
//!
//! After a change of the format, one command writes it anew:
//!
//! ```text
//! NOSLIP_WRITE=1 cargo test -p noslip-scene -- --ignored schema::dictionary
//! ```

use super::schema;
use scene::EFFECTS;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fuzz/scene.dict");

/// What is no key and no name of an effect: values, headings, and the methods that the fuzzer's programs accept.
const OTHERS: &[&str] = &[
    " = ",
    "-0.0",
    "1e308",
    "5e-324",
    "[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]",
    "[[effects]]",
    "[run]",
    "[sleigh]",
    "[start]",
    "[system]",
    "dla",
    "dla-alpha",
    "gauss8",
    "inf",
    "nan",
    "rk4",
    "true",
];

/// The keys of all objects that the schema describes.
fn keys<'a>(schema: &'a Value, found: &mut BTreeSet<&'a str>) {
    match schema {
        Value::Object(object) => {
            if let Some(Value::Object(properties)) = object.get("properties") {
                found.extend(properties.keys().map(String::as_str));
            }
            object.values().for_each(|value| keys(value, found));
        }
        Value::Array(values) => values.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

fn dictionary() -> String {
    let schema = schema();
    let mut words: BTreeSet<&str> = OTHERS.iter().copied().chain(EFFECTS.iter().map(|info| info.name)).collect();
    keys(&schema, &mut words);
    let lines: String = words.iter().map(|word| format!("\"{word}\"\n")).collect();
    format!(
        "# The words of scene files, made from docs/scene.schema.json by crates/scene/tests/schema/dictionary.rs.\n{lines}"
    )
}

#[test]
fn the_fuzzer_has_every_word() {
    let (expected, file) = (dictionary(), fs::read_to_string(FILE).unwrap());
    assert!(expected.contains("\"trailers\"") && expected.contains("\"wave_number\""), "{expected}");
    assert_eq!(file, expected, "NOSLIP_WRITE=1 cargo test -p noslip-scene -- --ignored schema::dictionary");
}

#[test]
#[ignore = "writes the dictionary of the fuzzer, if NOSLIP_WRITE=1"]
fn refresh() {
    if std::env::var_os("NOSLIP_WRITE").is_some_and(|value| value == "1") {
        fs::write(FILE, dictionary()).unwrap();
    }
}
