use dla::RunError;
use harness::{EnergyJump, Record};
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
        object["warnings"] = json!([jump.to_string()]);
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
