//! Common parts of the exponents of one motion and the largest exponents of many.

use crate::args::LyapunovArguments;
use crate::command_line::CommandLine;
use crate::error::CliError;
use crate::provenance::Provenance;
use crate::starts::with_energy;
use dla::Schedule;
use harness::analysis::LyapunovError;
use scene::{AnyScene, Built, BuiltScene, StartPlace};
use serde_json::json;

/// Default time before the run that is not counted, as a fraction of the run.
const SETTLE: f64 = 0.1;

/// The error for a scene without a motion of its own.
fn imposed() -> CliError {
    CliError::Request(
        "the scene imposes velocities (servo, tracer): accepted are scenes that only the blade constrains".to_owned(),
    )
}

/// The system of a scene that has a motion of its own.
///
/// # Errors
/// [`CliError::Request`] of a scene that imposes velocities.
pub(crate) fn free(scene: &AnyScene) -> Result<BuiltScene, CliError> {
    let built = scene.built_for_analysis()?;
    if built.system().imposes_velocities() { Err(imposed()) } else { Ok(built) }
}

/// The steps that are counted, and those before them.
pub(crate) fn schedule(arguments: &LyapunovArguments, scene: &AnyScene) -> (Schedule, u64) {
    let schedule = scene.schedule();
    let settle = arguments.settle.unwrap_or(SETTLE * scene.run().duration) / schedule.step;
    (schedule, settle.ceil() as u64)
}

/// The provenance of exponents, with the interruption if a signal ended the work.
pub(crate) fn provenance(arguments: &LyapunovArguments, scene: &AnyScene, interrupted: Option<&str>) -> Provenance {
    let LyapunovArguments { scene: shared, exponents, settle, energy, map, out, .. } = arguments;
    let (run, step) = (scene.run(), scene.schedule().step);
    let settle = settle.unwrap_or(SETTLE * run.duration);
    let command = CommandLine::of("lyapunov", &shared.scene, &shared.set).run(run, step).number("--settle", settle);
    let command = command.maybe("--exponents", *exponents);
    let command = command.maybe("--energy", energy.map(|energy| format!("{energy:?}")));
    let command = map.iter().fold(command, |command, range| command.with("--map", range));
    let command = command.maybe("--out", out.as_ref().map(|out| out.display()));
    let notes = json!({"method": run.method, "step": step, "duration": run.duration, "settle": settle});
    Provenance::on((scene.title(), scene.to_toml().ok()), Some(&command), notes).interrupted(interrupted)
}

/// A start with the energy that is asked for.
pub(crate) fn asked(system: &Built<'_>, start: StartPlace, wanted: Option<f64>) -> Result<StartPlace, CliError> {
    let Some(wanted) = wanted else { return Ok(start) };
    with_energy(system, &start, wanted).ok_or_else(|| {
        let at_rest = system.mechanism().energy(0.0, &start.0, &vec![0.0; start.1.len()]);
        CliError::Request(format!(
            "--energy {wanted:?}: no multiple of the velocity of the start has this energy; at rest at the start the \
                energy is {at_rest:?} J"
        ))
    })
}

pub(crate) fn refused(error: LyapunovError) -> CliError {
    match error {
        LyapunovError::Count { .. } => CliError::Request(format!("--exponents: {error}")),
        error => CliError::Request(error.to_string()),
    }
}
