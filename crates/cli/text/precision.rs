use super::compare::distance;
use super::{facts, told};
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::precision::{HALVINGS, KNOWN, KnownEnd, Measurement};
use crate::progress::{self, Interruptible};
use harness::Method;
use harness::precision::{Bench, Limits, Motion, Reference, rounds, work_precision};
use scene::{StartedText, TextScene, with_text};

/// Measures what accuracy costs on a system of text: the largest error of a coordinate at the end against the time of a run, by runs of
/// `longest` (s) at most; of a duration that is `chosen` for the user there may be less.
pub(crate) fn measure(
    scene: &TextScene,
    methods: &[Method],
    longest: f64,
    chosen: bool,
    interrupt: &Interrupt,
) -> Result<Measurement, CliError> {
    told::note_moves(scene);
    with_text!(super::system(scene)?, started => measured(scene, &started, methods, (longest, chosen), interrupt))
}

fn measured<const N: usize, const M: usize>(
    scene: &TextScene,
    StartedText { system, q, v }: &StartedText<N, M>,
    methods: &[Method],
    (longest, chosen): (f64, bool),
    interrupt: &Interrupt,
) -> Result<Measurement, CliError> {
    let failed = |reason: String| CliError::Computation(vec![reason]);
    let (mut duration, mut halvings) = (scene.run.duration, 0);
    let (motion, reference) = loop {
        let motion = Motion::new(&**system, *q, *v, duration);
        let reference = Reference::converged(&motion, &distance);
        let unsure = reference.as_ref().map_or(true, |reference| reference.error > KNOWN);
        if !(chosen && unsure && halvings < HALVINGS) {
            break (motion, reference);
        }
        duration *= 0.5;
        halvings += 1;
    };
    let Reference { q: end, steps, error, .. } = reference.map_err(|error| failed(error.to_string()))?;
    let end_error = |method: &Method, steps: u64| motion.end(method, steps).map(|q| distance(&q, &end));
    let aligned = |steps: u64| motion.aligned(steps);
    let bench = Bench { duration, reference_error: error, end_error: &end_error, aligned: &aligned };
    let limits = Limits { fewest: motion.aligned(2), longest };
    let bar = progress::bar(&format!("{} precision", scene.name), methods.len() as u64 + rounds());
    let mut progress = Interruptible { bar, interrupt };
    let (curves, clock) = work_precision(&bench, methods, &limits, &mut progress);
    progress.bar.finish_and_clear();
    let mut facts = facts::listed(scene);
    // The steps are those of the ladders, not the scene's.
    facts.pop();
    let reference = KnownEnd { closed: false, by: "gauss16", steps, error, end: () };
    Ok(Measurement { duration, reference, clock, facts, curves })
}
