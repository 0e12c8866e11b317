//! The objects that commands print, and a comparison as CSV with the same digits.

use crate::format::quoted;
use crate::provenance::{Provenance, headed};
use dla::RunError;
use harness::{EnergyJump, Record};
use report::{Numbers, file_stem};
use scene::AnyScene;
use serde_json::{Value, json};

/// The object that `run --json` prints, with the state at the end.
pub(crate) fn record_of(scene: &str, record: &Record, end: &Value) -> Value {
    let mut object = json!({
        "scene": scene,
        "method": record.method.name,
        "order": record.method.order,
        "step": record.step,
        "steps": record.steps,
        "duration": record.t,
        "wall_seconds": record.wall_seconds,
        "newton": {"mean": record.newton.mean, "max": record.newton.max},
        "energy": {
            "initial": record.energy.initial,
            "final": record.energy.last,
            "work": record.energy.work,
            "max_error": record.energy.max_error,
        },
        "constraint": {"max": record.constraint_max},
        "final": end,
    });
    if let Some(jump) = record.energy.jump {
        let EnergyJump { time, change, energy, count } = jump;
        object["energy"]["jump"] = json!({"t": time, "change": change, "energy": energy, "steps": count});
    }
    let warnings = record.warnings();
    if !warnings.is_empty() {
        object["warnings"] = json!(warnings);
    }
    if record.derivation_seconds > 0.0 {
        object["derivation_seconds"] = json!(record.derivation_seconds);
    }
    if let Some(failure) = &record.failure {
        object["failure"] = self::failure(failure);
    }
    if record.refusal().is_some() {
        object["refused"] = json!(true);
    }
    if record.interrupted {
        object["interrupted"] = json!(true);
    }
    object
}

/// The failed step, its time and the reason.
pub(crate) fn failure(failure: &RunError) -> Value {
    json!({
        "step": failure.step,
        "time": failure.time,
        "reason": failure.source.to_string(),
        "iterations": failure.source.iterations(),
        "corrections": failure.source.history().map(|history| history.iter().collect::<Vec<_>>()),
        "hint": failure.hint().map(|hint| hint.to_string()),
    })
}

/// The same object in a row of `compare --json`, with the error at the end, the drift of the energy, the constraint in its
/// other senses, the cost, and the methods that it overtakes. A run that did not reach its end has no error there and no verdict.
pub(crate) fn compared_of(scene: &str, run: &Record, end: &Value, error: Option<f64>, better: &[(&str, f64)]) -> Value {
    let mut object = record_of(scene, run, end);
    object["energy"]["drift_per_time"] = json!(run.energy.drift_per_time);
    let drift = &run.energy.drift;
    object["energy"]["amplitude"] = json!(drift.amplitude);
    object["energy"]["slope"] = json!(drift.slope);
    object["energy"]["slope_ci"] = json!(drift.slope_ci);
    object["energy"]["exponent"] = json!(drift.exponent);
    if let Some(verdict) = run.verdict() {
        object["energy"]["verdict"] = json!(verdict.name());
    }
    object["constraint"]["step_max"] = json!(run.step_constraint_max);
    object["constraint"]["leaf_max"] = json!(run.leaf_max);
    if run.is_whole() {
        object["error"] = json!(error);
    }
    object["seconds_per_simulated_second"] = json!(run.seconds_per_simulated_second());
    let better = better.iter().map(|(method, from)| json!({"method": method, "from": from}));
    object["better_than"] = better.collect();
    object
}

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
pub(crate) fn comparison(scene: &str, rows: &[&Value], interrupted: bool) -> Value {
    let mut object = json!({"scene": scene, "rows": rows});
    if interrupted {
        object["interrupted"] = json!(true);
    }
    object
}

/// The files beside the page.
pub(crate) fn files(scene: &AnyScene, rows: &[&Value], interrupted: Option<&str>) -> Vec<Numbers> {
    let name = scene.name();
    let text = format!("{:#}\n", comparison(name, rows, interrupted.is_some()));
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
