use crate::counted::Counted;
use crate::timing::median_seconds;
use dla::{Dla, Mechanics, Part, Piece, PiecewiseMechanics, RunError, Schedule, State, drive_part, piece_by_piece};
use std::cell::Cell;
use std::hint::black_box;

/// The time of a step of `dla`, solved in general form (ns), as the mean over a run and the median of repeated runs: no closed form of
/// the step is used.
///
/// # Errors
/// [`RunError`] where the run fails.
#[inline(never)]
pub fn step_time<const N: usize, const M: usize>(
    system: &dyn PiecewiseMechanics<N, M>,
    schedule: &Schedule,
    q: [f64; N],
    v: [f64; N],
) -> Result<f64, RunError> {
    let start = State::new(q, v, system.angles());
    let run = |start: State<N>| made(system, schedule, start, |piece, run| run(piece));
    let steps = run(start)?;
    let seconds = median_seconds(|| {
        // The same run has just succeeded.
        black_box(run(black_box(start)).is_ok());
    });
    Ok(1e9 * seconds / steps.max(1) as f64)
}

/// How often such a step evaluates the Lagrangian, the forces or the constraint, with derivatives or without.
///
/// # Errors
/// [`RunError`] where the run fails.
#[inline(never)]
pub fn step_evaluations<const N: usize, const M: usize>(
    system: &dyn PiecewiseMechanics<N, M>,
    schedule: &Schedule,
    q: [f64; N],
    v: [f64; N],
) -> Result<f64, RunError> {
    let evaluations = Cell::new(0);
    let counting = |piece: &dyn Mechanics<N, M>, run: &mut PieceRun<'_, N, M>| {
        run(&Counted { system: piece, evaluations: &evaluations })
    };
    let steps = made(system, schedule, State::new(q, v, system.angles()), counting)?;
    Ok(evaluations.get() as f64 / steps.max(1) as f64)
}

/// Makes the steps of a piece, on the system that is given.
type PieceRun<'a, const N: usize, const M: usize> = dyn FnMut(&dyn Mechanics<N, M>) -> Result<Part, RunError> + 'a;

/// A run of which `on` gives each piece, or something in its place, to the steps.
fn made<const N: usize, const M: usize>(
    system: &dyn PiecewiseMechanics<N, M>,
    schedule: &Schedule,
    mut state: State<N>,
    on: impl Fn(&dyn Mechanics<N, M>, &mut PieceRun<'_, N, M>) -> Result<Part, RunError>,
) -> Result<u64, RunError> {
    let mut method = Dla::midpoint();
    piece_by_piece(system, schedule, &mut state, |piece, Piece { steps, schedule }, state| {
        on(piece, &mut |piece| drive_part(piece, &mut method, &schedule, steps.clone(), state, ()))
    })
}
