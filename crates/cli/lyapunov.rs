use crate::analysis::{Analysis, AnalysisResult, with_wanted_energy};
use crate::args::LyapunovArguments;
use crate::command_line::CommandLine;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::{json, progress, stability_map, table};
use dla::{Schedule, has_tangents};
use harness::analysis::{Lyapunov, LyapunovError, LyapunovFailure, LyapunovRequest, MotionVerdict, kaplan_yorke};
use report::{Chart, Layer};
use scene::{Built, Column, MAX_STEPS, StartPlace};
use serde_json::{Value, json};

/// Default durations (s): of one motion, and of each motion of a map.
const DURATION: f64 = 10_000.0;
const MAP_DURATION: f64 = 500.0;
/// Default time before the run that is not counted, as a fraction of the run.
const SETTLE: f64 = 0.1;

/// `noslip lyapunov`: the exponents of one motion, or the largest of many.
pub(crate) fn lyapunov(arguments: &LyapunovArguments) -> Result<(), CliError> {
    let usual = if arguments.map.is_empty() { DURATION } else { MAP_DURATION };
    let mut analysis = Analysis::open("lyapunov", &arguments.scene, &arguments.method, usual)?;
    analysis.scene = analysis.scene.uncut();
    has_tangents(&analysis.method)
        .map_err(|reason| CliError::Request(format!("--method {}: {reason}", arguments.method)))?;
    check_settle(arguments, analysis.scene.run().actual_step())?;
    let built = analysis.begin(arguments.out.as_deref())?;
    let (system, start) = (built.system(), (built.q.clone(), built.v.clone()));
    match &arguments.map[..] {
        [] => exponents(arguments, &analysis, &system, start),
        [across, up] => stability_map::map(arguments, &analysis, [across, up], &system, &start),
        _ => {
            let problem = "--map must be given twice: first the horizontal axis, then the vertical axis";
            Err(CliError::Request(problem.to_owned()))
        }
    }
}

/// Refuses a time before the run that has more steps than any run may have.
fn check_settle(arguments: &LyapunovArguments, step: f64) -> Result<(), CliError> {
    let (settle, most) = (arguments.settle.unwrap_or(0.0), MAX_STEPS as f64 * step);
    if settle <= most {
        return Ok(());
    }
    let problem =
        format!("--settle: {settle:e} s are more than 1e12 steps of {step:?} s; accepted: at most {most:e} s");
    Err(CliError::Request(problem))
}

/// The steps that are counted, and those before them.
pub(crate) fn schedule(arguments: &LyapunovArguments, analysis: &Analysis<'_>) -> (Schedule, u64) {
    let schedule = analysis.scene.schedule();
    (schedule, (settle(arguments, analysis) / schedule.step).ceil() as u64)
}

/// The time before the run (s).
fn settle(arguments: &LyapunovArguments, analysis: &Analysis<'_>) -> f64 {
    arguments.settle.unwrap_or(SETTLE * analysis.scene.run().duration)
}

/// The command that makes the exponents again, and the notes on their file.
pub(crate) fn again(arguments: &LyapunovArguments, analysis: &Analysis<'_>) -> (CommandLine, Value) {
    let settle = settle(arguments, analysis);
    let command = analysis.again().number("--settle", settle).maybe("--exponents", arguments.exponents);
    let command = command.maybe_number("--energy", arguments.energy);
    (arguments.map.iter().fold(command, |command, range| command.with("--map", range)), json!({"settle": settle}))
}

pub(crate) fn refused(error: LyapunovError) -> CliError {
    match error {
        LyapunovError::Count { .. } => CliError::Request(format!("--exponents: {error}")),
        error => CliError::Request(error.to_string()),
    }
}

/// The exponents of the motion from one start.
fn exponents(
    arguments: &LyapunovArguments,
    analysis: &Analysis<'_>,
    system: &Built<'_>,
    start: StartPlace,
) -> Result<(), CliError> {
    let (q, v) = with_wanted_energy(system, start, arguments.energy)?;
    let (schedule, settle) = schedule(arguments, analysis);
    let request =
        LyapunovRequest { schedule, settle, exponents: arguments.exponents.map(|count| count as usize), q, v };
    let (interrupt, mechanism) = (Interrupt::listen(), system.mechanism());
    let name = analysis.method.info().name;
    let found = progress::shown(name, settle.saturating_add(schedule.steps), &interrupt, |progress| {
        harness::analysis::lyapunov(&*mechanism, system.own(), &analysis.method, &request, progress)
    });
    let found = found.map_err(refused)?;
    let energy = mechanism.energy(0.0, &request.q, &request.v);
    let each = (1..=found.exponents.len()).map(|i| Column::new(format!("exponent_{i}"), "1/s"));
    let mut lines = analysis.lines(found.time, "");
    lines.push(("energy".to_owned(), format!("{} J", table::number(energy))));
    lines.extend(told(&found));
    let (again, notes) = again(arguments, analysis);
    analysis.tell(AnalysisResult {
        columns: std::iter::once(Column::new("t", "s")).chain(each).collect(),
        rows: &|| found.running.iter().map(|at| [&[at.time][..], &at.exponents].concat()).collect(),
        chart: &|| chart(analysis.scene.title(), &found),
        object: &|| analysis.object(found.time, object(&found, energy)),
        lines,
        again,
        notes,
        warning: None,
        failures: found.failure.map(|failure| format!("{name}: {failure}")).into_iter().collect(),
        interrupted: interrupt.asked().then(|| format!("the exponents cover {} s", table::number(found.time))),
    })
}

/// Whether the exponents are all that the motion has.
fn is_whole(found: &Lyapunov) -> bool {
    found.exponents.len() == found.most
}

fn object(found: &Lyapunov, energy: f64) -> Value {
    let running: Vec<Value> = doublings(found).map(|at| json!({"time": at.time, "exponents": at.exponents})).collect();
    let mut object = json!({
        "energy": energy,
        "exponents": found.exponents,
        "ci": found.ci,
        "sum": found.sum(),
        "divergence_mean": found.divergence_mean,
        "verdict": found.verdict.name(),
        "convergence": running,
    });
    if is_whole(found) {
        object["dimension"] = json!(kaplan_yorke(&found.exponents));
    }
    if let MotionVerdict::Periodic { period, .. } = found.verdict {
        object["period"] = json!(period);
    }
    if let MotionVerdict::Steady { unstable } | MotionVerdict::Periodic { unstable, .. } = found.verdict {
        object["unstable"] = json!(unstable);
    }
    if let Some(failure) = found.failure {
        object["failure"] = json!(failure.to_string());
        if let LyapunovFailure::Step(failure) = &failure {
            object["failed_at"] = json::failure(failure);
        }
    }
    object
}

/// The exponents for a person.
fn told(found: &Lyapunov) -> Vec<(String, String)> {
    let mut lines = Vec::new();
    // A run that fails before anything is counted has no exponents.
    if found.time > 0.0 {
        for (i, (value, ci)) in found.exponents.iter().zip(&found.ci).enumerate() {
            let interval = ci.map_or_else(String::new, |ci| format!(" ± {ci:.5}"));
            lines.push((format!("exponent {}", i + 1), format!("{value:+.5}{interval} 1/s")));
        }
        let divergence = format!("{:+.7} 1/s", found.divergence_mean);
        if is_whole(found) {
            lines.push(("sum".to_owned(), format!("{:+.7} 1/s", found.sum())));
            lines.push(("mean divergence".to_owned(), divergence));
        } else {
            lines.push(("mean divergence".to_owned(), format!("{divergence}, the sum of all exponents")));
        }
        if is_whole(found) && has_attractor(found.verdict) {
            let dimension = kaplan_yorke(&found.exponents);
            lines.push(("dimension".to_owned(), format!("{dimension:.3}, by the formula of Kaplan and Yorke")));
        }
    }
    lines.push(("verdict".to_owned(), found.verdict.to_string()));
    lines
}

fn chart(title: &str, found: &Lyapunov) -> Chart {
    let line = |i: usize| Layer::Curves {
        label: format!("exponent {}", i + 1),
        curves: vec![found.running.iter().map(|at| [at.time, at.exponents[i]]).collect()],
    };
    Chart {
        title: format!("{title}: Lyapunov exponents over a run"),
        axes: ["t [s]".to_owned(), "running mean [1/s]".to_owned()],
        decades: [true, false],
        layers: (0..found.exponents.len()).map(line).collect(),
    }
}

/// Whether a motion may be on an attractor whose dimension its exponents tell: an unstable steady one is not, nor is one that
/// runs away.
fn has_attractor(verdict: MotionVerdict) -> bool {
    match verdict {
        MotionVerdict::Steady { unstable } | MotionVerdict::Periodic { unstable, .. } => !unstable,
        MotionVerdict::RunsAway => false,
        MotionVerdict::Regular | MotionVerdict::Chaotic | MotionVerdict::Undecided(_) => true,
    }
}

/// The estimates after a sixteenth of the run, an eighth, .., all.
fn doublings(found: &Lyapunov) -> impl Iterator<Item = &harness::analysis::Running> {
    let count = found.running.len();
    (0..5).rev().filter_map(move |k| found.running.get((count >> k).checked_sub(1)?))
}
