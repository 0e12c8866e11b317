use crate::args::SceneArguments;
use crate::error::CliError;
use crate::{inspect, table, terminal};
use dla::{RunError, Schedule};
use harness::{step_evaluations, step_time};
use scene::{Built, Scene, SceneEffect, Visitor};
use serde_json::json;

/// The steps over which a cost is a mean.
const STEPS: u64 = 2000;

/// One row: some of a scene's effects, and what a step costs with them.
struct Row {
    effects: Vec<&'static str>,
    ns_per_step: f64,
    evaluations_per_step: f64,
}

/// `noslip cost`: what each effect of a scene costs a step, for the scene with none, with each alone, and with all.
pub(crate) fn cost(arguments: &SceneArguments) -> Result<(), CliError> {
    let scene = inspect::load(arguments, None)?;
    let mut subsets: Vec<Vec<SceneEffect>> = vec![Vec::new()];
    subsets.extend(scene.effects.iter().map(|effect| vec![effect.clone()]));
    if scene.effects.len() > 1 {
        subsets.push(scene.effects.clone());
    }
    let whole = inspect::schedule(&scene);
    let schedule = Schedule { steps: whole.steps.min(STEPS), ..whole };
    let mut rows = Vec::new();
    let mut failures = Vec::new();
    for effects in subsets {
        let names: Vec<&'static str> = effects.iter().map(SceneEffect::kind).collect();
        let part = Scene { effects, ..scene.clone() };
        let ns_per_step = part.visit(Time(schedule))?;
        // Of other types than those that are timed: they evaluate as often, and are half as many to be compiled.
        let evaluations_per_step = part.visit(Evaluations(schedule))?;
        match ns_per_step.and_then(|ns| Ok((ns, evaluations_per_step?))) {
            Ok((ns_per_step, evaluations_per_step)) => {
                rows.push(Row { effects: names, ns_per_step, evaluations_per_step });
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
        terminal::print_json(&json!({"scene": scene.name, "rows": rows}))?;
    } else {
        let heading =
            format!("{} ({}): a step of dla by automatic derivatives, the mean over a run\n", scene.title, scene.name);
        terminal::print(&(heading + &table::right_aligned(&COLUMNS, &cells(&rows))))?;
    }
    CliError::of_failures(failures)
}

const COLUMNS: [&str; 4] = ["effects", "ns/step", "more", "evaluations/step"];

/// The rows as text, each with what it costs more than the first.
fn cells(rows: &[Row]) -> Vec<Vec<String>> {
    let bare = rows.first().map_or(f64::NAN, |row| row.ns_per_step);
    let cells = |row: &Row| {
        vec![
            if row.effects.is_empty() { "none".to_owned() } else { row.effects.join(", ") },
            format!("{:.1}", row.ns_per_step),
            if row.effects.is_empty() { "-".to_owned() } else { format!("{:+.1}", row.ns_per_step - bare) },
            format!("{:.2}", row.evaluations_per_step),
        ]
    };
    rows.iter().map(cells).collect()
}

struct Time(Schedule);

impl Visitor for Time {
    type Output = Result<f64, RunError>;

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Self::Output {
        step_time(&*system, &self.0, q, v)
    }
}

struct Evaluations(Schedule);

impl Visitor for Evaluations {
    type Output = Result<f64, RunError>;

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Self::Output {
        step_evaluations(&*system, &self.0, q, v)
    }
}
