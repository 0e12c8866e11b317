use super::compare::distance;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::measurement::{KnownEnd, Measurement};
use crate::progress::Interruptible;
use crate::{facts, progress};
use assembly::AssemblyState;
use assembly::parts::Train;
use dla::{RunError, Schedule};
use harness::precision::{Bench, LadderLimits, rounds, work_precision};
use harness::{Method, assembly_end};
use scene::Scene;
use sleigh::SleighState;
use std::time::{Duration, Instant};

/// What accuracy costs on a train: error of the first blade at the end against the time of a run.
pub(crate) fn measure(
    scene: &Scene,
    (train, start): &(Train, AssemblyState),
    methods: &[Method],
    longest: f64,
    interrupt: &Interrupt,
) -> Result<Measurement, CliError> {
    let (assembly, duration) = (&train.assembly, scene.run.duration);
    let end = |method: &Method, steps: u64| -> Result<SleighState, RunError> {
        let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
        match assembly_end(assembly, method, &schedule, start, &mut ()) {
            Ok(state) => Ok(train.blade(state.as_ref().unwrap_or(start), 0)),
            Err(error) => Err(RunError::new(error.step, error.time, error.source.step_error())),
        }
    };
    let reference = converged(&end)?;
    let end_error = |method: &Method, steps: u64| end(method, steps).map(|state| distance(&state, &reference.end));
    let bench = Bench { duration, reference_error: reference.error, end_error: &end_error, aligned: &|steps| steps };
    // Each piece between jumps needs a step.
    let fewest = 2.max(1 + assembly.jump_times(0.0, duration).len() as u64);
    let limits = LadderLimits { fewest, longest };
    let bar = progress::bar(&format!("{} precision", scene.name), methods.len() as u64 + rounds());
    let mut progress = Interruptible { bar, interrupt };
    let (curves, clock) = work_precision(&bench, methods, &limits, &mut progress);
    progress.bar.finish_and_clear();
    let mut facts = facts::of_sleigh(scene, &scene.start, assembly.energy(0.0, start), "");
    // The steps are those of the ladders, not the scene's.
    facts.pop();
    Ok(Measurement { duration, reference: reference.told(), clock, facts, curves })
}

/// The end by `dla8`, its steps doubled until two successive ends are no nearer than those before, or it takes too long.
fn converged(end: &dyn Fn(&Method, u64) -> Result<SleighState, RunError>) -> Result<KnownEnd<SleighState>, CliError> {
    /// Of one run.
    const LONG: Duration = Duration::from_secs(10);
    const FEWEST: u64 = 32;
    let dla8 = Method::named("dla8", None)?;
    let mut best: Option<KnownEnd<SleighState>> = None;
    let (mut before, mut steps, mut failure) = (None, FEWEST, String::new());
    while steps <= FEWEST << 12 {
        let clock = Instant::now();
        match end(&dla8, steps) {
            Ok(state) => {
                let error = before.as_ref().map(|before| distance(before, &state));
                if let Some(error) = error {
                    if best.as_ref().is_some_and(|best| error >= best.error) {
                        break;
                    }
                    best = Some(KnownEnd { closed: false, by: "dla8", steps, error, end: state });
                }
                before = Some(state);
            }
            Err(error) => failure = error.to_string(),
        }
        if clock.elapsed() > LONG {
            break;
        }
        steps *= 2;
    }
    best.ok_or_else(|| CliError::Computation(vec![format!("the reference: too few runs of dla8 succeed: {failure}")]))
}
