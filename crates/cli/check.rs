//! `noslip check`: describes valid scenes and reports the errors of invalid ones. `noslip equations`: the reduced equations of a system of text.

use crate::args::{CheckArguments, EquationsArguments};
use crate::error::CliError;
use crate::facts::described;
use crate::inspect::method_names;
use crate::{inspect, table, terminal};
use scene::{AnyScene, Overrides};
use serde_json::{Map, Value, json};

/// Checks every scene: an invalid one does not hide the next.
pub(crate) fn check(arguments: &CheckArguments) -> Result<(), CliError> {
    let names = method_names();
    let (mut objects, mut failed) = (Vec::new(), Vec::new());
    let mut above = "";
    for name in &arguments.scenes {
        let load = || -> Result<_, CliError> {
            let scene = AnyScene::load_with(name, &arguments.set.set, &Overrides::default(), &names)?;
            let facts = described(&scene)?;
            Ok((scene, facts))
        };
        match load() {
            Ok((scene, facts)) if arguments.json => objects.push(valid(&scene, &facts)),
            Ok((scene, facts)) => {
                let heading = format!("{above}{}: valid, \"{}\"\n", scene.name(), scene.title());
                terminal::print(&(heading + &table::aligned(&facts)))?;
                above = "\n";
            }
            Err(error) => {
                objects.push(invalid(name, &error));
                failed.push(error);
            }
        }
    }
    if arguments.json {
        terminal::print_json(&json!(objects))?;
    }
    // The last error is told by whoever called this.
    let last = failed.pop();
    failed.iter().for_each(terminal::fail);
    last.map_or(Ok(()), Err)
}

fn valid(scene: &AnyScene, facts: &[(String, String)]) -> Value {
    let run = scene.run();
    let effects: Vec<&str> = match scene {
        AnyScene::Sleigh(scene) => scene.effects.iter().map(scene::SceneEffect::kind).collect(),
        AnyScene::Text(_) => Vec::new(),
    };
    // There may be several effects, which `effects` lists.
    let facts: Map<String, Value> =
        facts.iter().filter(|(name, _)| name != "effect").map(|(name, value)| (name.clone(), json!(value))).collect();
    json!({"scene": scene.name(), "valid": true, "title": scene.title(), "method": run.method, "step": run.actual_step(),
           "steps": run.steps(), "duration": run.duration, "effects": effects, "facts": facts})
}

fn invalid(name: &str, error: &CliError) -> Value {
    let mut object = json!({"scene": name, "valid": false, "error": error.to_string()});
    if let CliError::Scene(error) = error
        && let Some(finding) = error.finding()
    {
        object["field"] = json!(finding.field);
        object["problem"] = json!(finding.problem);
        object["accepted"] = json!(finding.accepted);
        object["line"] = json!(finding.place.map(|place| place.line));
        object["column"] = json!(finding.place.map(|place| place.column));
    }
    object
}

/// `noslip equations`: the rates of coordinates and quasi-velocities, as formulas of these and of the time `t`.
pub(crate) fn equations(arguments: &EquationsArguments) -> Result<(), CliError> {
    let scene = AnyScene::load_with(&arguments.scene, &arguments.set.set, &Overrides::default(), &method_names())?;
    let AnyScene::Text(text) = &scene else {
        let name = scene.name();
        return Err(CliError::Request(format!(
            "{name} is a sleigh, whose equations are on the page `scenes` of the documentation; accepted is a system of text"
        )));
    };
    inspect::moves(&scene);
    let Some(written) = text.model.written_equations(&text.start) else {
        return Err(CliError::Computation(vec![format!(
            "{}: the reduced equations are too large to be written",
            scene.name()
        )]));
    };
    if arguments.json {
        return terminal::print_json(&json!({
            "scene": scene.name(), "title": scene.title(), "duration": text.run.duration, "unknowns": written.unknowns,
            "coordinates": text.model.coordinates().len(), "statements": written.statements, "rates": written.rates,
            "start": written.start,
        }));
    }
    let mut lines = String::new();
    for (name, meaning) in &written.statements {
        lines.push_str(&format!("{name} = {meaning}\n"));
    }
    for (name, rate) in written.unknowns.iter().zip(&written.rates) {
        lines.push_str(&format!("{name}' = {rate}\n"));
    }
    let start =
        written.unknowns.iter().zip(&written.start).map(|(name, value)| format!("{name} = {}", table::number(*value)));
    lines.push_str(&format!("start: {}\n", start.collect::<Vec<_>>().join(", ")));
    terminal::print(&lines)
}
