use crate::timing::median_seconds;
use dla::{AnyState, Mechanism, Part, Piece, RunError, Schedule, make_steps, piece_by_piece};
use std::cell::Cell;
use std::hint::black_box;

/// The time of a step of `dla`, solved in general form (ns), as the mean over a run and the median of repeated runs: no closed form of
/// the step is used.
///
/// # Errors
/// [`RunError`] if the run fails.
pub fn step_time(system: &dyn Mechanism, schedule: &Schedule, q: &[f64], v: &[f64]) -> Result<f64, RunError> {
    let start = system.state(q, v);
    let run = |start: AnyState| made(system, schedule, start, |piece, run| run(piece));
    let steps = run(start.clone())?;
    let seconds = median_seconds(|| {
        // The same run has just succeeded.
        black_box(run(black_box(&start).clone()).is_ok());
    });
    Ok(1e9 * seconds / steps.max(1) as f64)
}

/// How often such a step evaluates the Lagrangian, the forces or the constraint, with derivatives or without.
///
/// # Errors
/// [`RunError`] if the run fails.
pub fn step_evaluations(system: &dyn Mechanism, schedule: &Schedule, q: &[f64], v: &[f64]) -> Result<f64, RunError> {
    let evaluations = Cell::new(0);
    let steps = made(system, schedule, system.state(q, v), |piece, run| piece.counted(&evaluations, run))?;
    Ok(evaluations.get() as f64 / steps.max(1) as f64)
}

/// Makes the steps of a piece, on the system that is given.
type PieceRun<'a> = dyn FnMut(&dyn Mechanism) + 'a;

/// A run of which `on` gives each piece, or something in its place, to the steps.
fn made(
    system: &dyn Mechanism,
    schedule: &Schedule,
    mut state: AnyState,
    on: impl Fn(&dyn Mechanism, &mut PieceRun<'_>),
) -> Result<u64, RunError> {
    piece_by_piece(0, system, schedule, &mut state, |piece, Piece { steps, schedule }, state| {
        let mut outcome = Ok(Part { made: steps.start, stopped: true });
        on(piece, &mut |piece| {
            outcome = make_steps(piece, &mut *piece.general_map(), &schedule, steps.clone(), state, &mut ());
        });
        outcome
    })
}
