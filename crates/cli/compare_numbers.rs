//! The numbers of a comparison for programs: as one JSON object, and as CSV with the same digits.

use crate::precision_text::quoted;
use harness::report::Numbers;
use serde_json::{Value, json};

/// The columns of the CSV file, and where the JSON row has them.
const COLUMNS: [(&str, &str); 21] = [
    ("method", "/method"),
    ("order", "/order"),
    ("step [s]", "/step"),
    ("steps", "/steps"),
    ("duration [s]", "/duration"),
    ("constraint [m/s]", "/constraint/max"),
    ("over steps [m/s]", "/constraint/step_max"),
    ("leaf", "/constraint/leaf_max"),
    ("energy error [J]", "/energy/max_error"),
    ("amplitude [J]", "/energy/amplitude"),
    ("energy drift [W]", "/energy/slope"),
    ("its interval [W]", "/energy/slope_ci"),
    ("exponent", "/energy/exponent"),
    ("verdict", "/energy/verdict"),
    ("end error [m or rad]", "/error"),
    ("x [m]", "/final/x"),
    ("y [m]", "/final/y"),
    ("heading [rad]", "/final/heading"),
    ("Newton", "/newton/mean"),
    ("wall [s]", "/wall_seconds"),
    ("cost [s/s]", "/seconds_per_simulated_second"),
];
/// Of a method that failed: the step, the time (s) that the run is valid up to, and why.
const FAILURE: [(&str, &str); 3] =
    [("failed at step", "/failure/step"), ("failed at t [s]", "/failure/time"), ("failure", "/failure/reason")];
/// The columns that a method that failed has besides: the others would be those of a part of the run.
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
pub(crate) fn files(scene: &str, rows: &[&Value], interrupted: bool) -> Vec<Numbers> {
    let json = format!("{:#}\n", json(scene, rows, interrupted));
    vec![Numbers { ending: "csv", text: csv(rows) }, Numbers { ending: "json", text: json }]
}

/// One line a method; what a row does not have is empty.
fn csv(rows: &[&Value]) -> String {
    let columns = || COLUMNS.iter().chain(&FAILURE);
    let header: Vec<&str> = columns().map(|(name, _)| *name).collect();
    let line = |row: &&Value| {
        let failed = row.get("failure").is_some();
        let cell = |(k, (_, place)): (usize, &(&str, &str))| match row.pointer(place) {
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
