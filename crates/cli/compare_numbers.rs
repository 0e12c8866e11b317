//! The numbers of a comparison for programs: as one JSON object, and as CSV with the same digits.

use crate::format::quoted;
use crate::provenance::{Provenance, headed};
use report::{Numbers, file_stem};
use scene::AnyScene;
use serde_json::{Value, json};

/// A column of the CSV file: its heading, the JSON pointer to its field, and the data type.
type Told = (&'static str, &'static str, &'static str);

/// The columns of a run.
const COLUMNS: [Told; 21] = [
    ("method", "/method", "string"),
    ("order", "/order", "integer"),
    ("step [s]", "/step", "double"),
    ("steps", "/steps", "integer"),
    ("duration [s]", "/duration", "double"),
    ("constraint [m/s]", "/constraint/max", "double"),
    ("over steps [m/s]", "/constraint/step_max", "double"),
    ("leaf", "/constraint/leaf_max", "double"),
    ("energy error [J]", "/energy/max_error", "double"),
    ("amplitude [J]", "/energy/amplitude", "double"),
    ("energy drift [W]", "/energy/slope", "double"),
    ("its interval [W]", "/energy/slope_ci", "double"),
    ("exponent", "/energy/exponent", "double"),
    ("verdict", "/energy/verdict", "string"),
    ("end error [m or rad]", "/error", "double"),
    ("x [m]", "/final/x", "double"),
    ("y [m]", "/final/y", "double"),
    ("heading [rad]", "/final/heading", "double"),
    ("Newton", "/newton/mean", "double"),
    ("wall [s]", "/wall_seconds", "double"),
    ("cost [s/s]", "/seconds_per_simulated_second", "double"),
];
/// Columns of a method that failed: step, time (s) up to which the run is valid, and reason.
const FAILURE: [Told; 3] = [
    ("failed at step", "/failure/step", "integer"),
    ("failed at t [s]", "/failure/time", "double"),
    ("failure", "/failure/reason", "string"),
];
/// Number of leading columns that a failed method also fills. Its later columns stay empty, as they would describe a partial run.
const KEPT: usize = 3;

/// The object that `compare --json` prints.
pub(crate) fn json(scene: &str, rows: &[&Value], interrupted: bool) -> Value {
    let mut object = json!({"scene": scene, "rows": rows});
    if interrupted {
        object["interrupted"] = json!(true);
    }
    object
}

/// The files beside the page.
pub(crate) fn files(scene: &AnyScene, rows: &[&Value], interrupted: Option<&str>) -> Vec<Numbers> {
    let name = scene.name();
    let text = format!("{:#}\n", json(name, rows, interrupted.is_some()));
    let provenance = Provenance::on(scene, None, json!({})).interrupted(interrupted);
    let described: Vec<Value> = columns().map(|(heading, _, datatype)| headed(heading, datatype)).collect();
    let metadata = provenance.document(&format!("{}.csv", file_stem(name)), &described);
    vec![
        Numbers { ending: "csv", text: csv(rows) },
        Numbers { ending: "csv-metadata.json", text: metadata },
        Numbers { ending: "json", text },
    ]
}

fn columns() -> impl Iterator<Item = &'static Told> {
    COLUMNS.iter().chain(&FAILURE)
}

/// One line a method; what a row does not have is empty.
fn csv(rows: &[&Value]) -> String {
    let header: Vec<&str> = columns().map(|(name, ..)| *name).collect();
    let line = |row: &&Value| {
        let failed = row.get("failure").is_some();
        let cell = |(k, (_, place, _)): (usize, &Told)| match row.pointer(place) {
            Some(_) if failed && (KEPT..COLUMNS.len()).contains(&k) => String::new(),
            None | Some(Value::Null) => String::new(),
            Some(Value::String(text)) => quoted(text),
            Some(value) => value.to_string(),
        };
        columns().enumerate().map(cell).collect::<Vec<_>>().join(",")
    };
    let lines: Vec<String> = std::iter::once(header.join(",")).chain(rows.iter().map(line)).collect();
    lines.join("\n") + "\n"
}
