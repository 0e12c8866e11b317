use crate::args::SceneArguments;
use crate::error::CliError;
use crate::{inspect, table, terminal};
use dla::Schedule;
use harness::{step_evaluations, step_time};
use scene::{AnyScene, Scene, SceneEffect, TextScene};
use serde_json::json;

/// The steps over which a cost is a mean.
const STEPS: u64 = 2000;

/// One row: a part of a scene, and what a step costs with it.
struct CostRow {
    effects: Vec<&'static str>,
    ns_per_step: f64,
    evaluations_per_step: f64,
}

/// A part of a scene: the effects of a sleigh, or the forces of a system of text, that are in it.
type Part = (Vec<&'static str>, AnyScene);

/// `noslip cost`: the cost of a step without effects, with each effect alone, and with all; for a system of text, without and with its
/// forces.
pub(crate) fn cost(arguments: &SceneArguments) -> Result<(), CliError> {
    let scene = inspect::load(arguments, None)?;
    inspect::moves(&scene);
    let (parts, operations) = match &scene {
        AnyScene::Sleigh(scene) => (with_effects(scene), None),
        AnyScene::Text(scene) => (with_forces(scene)?, Some(scene.model.operations())),
    };
    let whole = scene.schedule();
    let schedule = Schedule { steps: whole.steps.min(STEPS), ..whole };
    let mut rows = Vec::new();
    let mut failures = Vec::new();
    for (names, part) in parts {
        let built = part.built_for_analysis()?;
        let (system, q, v) = (built.system().mechanism(), &built.q, &built.v);
        let measured =
            step_time(&*system, &schedule, q, v).and_then(|ns| Ok((ns, step_evaluations(&*system, &schedule, q, v)?)));
        match measured {
            Ok((ns_per_step, evaluations_per_step)) => {
                rows.push(CostRow { effects: names, ns_per_step, evaluations_per_step });
            }
            Err(failure) if names.is_empty() => failures.push(format!("without effects: {failure}")),
            Err(failure) => failures.push(format!("with {}: {failure}", names.join(", "))),
        }
    }
    if arguments.json {
        let rows: Vec<_> = rows
            .iter()
            .map(|row| {
                json!({
                    "effects": row.effects,
                    "ns_per_step": row.ns_per_step,
                    "evaluations_per_step": row.evaluations_per_step,
                })
            })
            .collect();
        let mut object = json!({"scene": scene.name(), "rows": rows});
        if let Some([lagrangian, constraints, forces]) = operations {
            object["operations"] = json!({"lagrangian": lagrangian, "constraints": constraints, "forces": forces});
        }
        terminal::print_json(&object)?;
    } else {
        let name = format!("{} ({})", scene.title(), scene.name());
        let heading = table::wrapped(&format!("{name}: mean time of a step of dla with automatic derivatives"));
        let counted = operations.map_or_else(String::new, |[lagrangian, constraints, forces]| {
            format!("operations: {lagrangian} for the Lagrangian, {constraints} for the constraints, {forces} for the forces\n")
        });
        terminal::print(&(heading + &table::right_aligned(&COLUMNS, &cells(&rows)) + &counted))?;
    }
    CliError::of_failures(failures)
}

/// The scene without effects, with each alone, and with all.
fn with_effects(scene: &Scene) -> Vec<Part> {
    let mut subsets: Vec<Vec<SceneEffect>> = vec![Vec::new()];
    subsets.extend(scene.effects.iter().map(|effect| vec![effect.clone()]));
    if scene.effects.len() > 1 {
        subsets.push(scene.effects.clone());
    }
    let part = |effects: Vec<SceneEffect>| {
        let names = effects.iter().map(SceneEffect::kind).collect();
        (names, AnyScene::Sleigh(Box::new(Scene { effects, ..scene.clone() })))
    };
    subsets.into_iter().map(part).collect()
}

/// The system without its forces, and with them if it has any.
fn with_forces(scene: &TextScene) -> Result<Vec<Part>, CliError> {
    let bare = scene.without_forces().map_err(|error| CliError::Request(error.to_string()))?;
    let mut parts = vec![(Vec::new(), AnyScene::Text(Box::new(bare)))];
    if scene.model.has_forces() {
        parts.push((vec!["forces"], AnyScene::Text(Box::new(scene.clone()))));
    }
    Ok(parts)
}

const COLUMNS: [&str; 4] = ["effects", "ns/step", "more", "evaluations/step"];

/// The rows as text, each with what it costs more than the first.
fn cells(rows: &[CostRow]) -> Vec<Vec<String>> {
    let bare = rows.first().map_or(f64::NAN, |row| row.ns_per_step);
    let cells = |row: &CostRow| {
        vec![
            if row.effects.is_empty() { "none".to_owned() } else { row.effects.join(", ") },
            format!("{:.1}", row.ns_per_step),
            // Less than nothing is the noise of the clock.
            if row.effects.is_empty() { "-".to_owned() } else { format!("{:+.1}", (row.ns_per_step - bare).max(0.0)) },
            format!("{:.2}", row.evaluations_per_step),
        ]
    };
    rows.iter().map(cells).collect()
}
