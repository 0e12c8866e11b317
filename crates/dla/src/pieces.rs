use crate::projection::project;
use crate::{Mechanics, Part, RunError, Schedule, State, StepError};
use lagrangian::{Piecewise, System, whole_steps};
use std::ops::Range;

/// Cuts a run into parts, the steps between one jump and the next.
///
/// `jumps` are times inside the run (s), in any order.
///
/// # Errors
/// [`RunError`] with [`StepError::Jump`] names the first jump that falls inside a step.
pub fn pieces(schedule: &Schedule, mut jumps: Vec<f64>) -> Result<Vec<Range<u64>>, RunError> {
    let order = schedule.step.signum();
    jumps.sort_by(|a, b| f64::total_cmp(&(order * a), &(order * b)));
    let mut parts = Vec::new();
    let mut begin = 0;
    for time in jumps {
        let steps = (time - schedule.t0) / schedule.step;
        let Some(nearest) = whole_steps(steps) else {
            let step = steps.floor() as u64;
            return Err(RunError { step: step + 1, time: schedule.time(step), source: StepError::Jump { time } });
        };
        let end = (nearest as u64).min(schedule.steps);
        if end > begin {
            parts.push(begin..end);
            begin = end;
        }
    }
    if begin < schedule.steps || parts.is_empty() {
        parts.push(begin..schedule.steps);
    }
    Ok(parts)
}

/// A system for runs: its dependence on time may jump, as [`Piecewise`] says, and a run is made with one smooth piece after the other.
pub trait PiecewiseMechanics<const N: usize, const M: usize>: Mechanics<N, M> {
    /// The times of the jumps in the open interval from `from` to `to` (s), in any order.
    fn jump_times(&self, from: f64, to: f64) -> Vec<f64>;

    /// The smooth piece that holds at the time `t` (s), continued to all times.
    fn smooth_piece(&self, t: f64) -> Box<dyn PiecewiseMechanics<N, M> + '_>;
}

impl<const N: usize, const M: usize> std::fmt::Debug for dyn PiecewiseMechanics<N, M> + '_ {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let system: &dyn Mechanics<N, M> = self;
        system.fmt(f)
    }
}

impl<Sys: System<N, M> + Piecewise, const N: usize, const M: usize> PiecewiseMechanics<N, M> for Sys {
    fn jump_times(&self, from: f64, to: f64) -> Vec<f64> {
        self.jumps(from, to)
    }

    fn smooth_piece(&self, t: f64) -> Box<dyn PiecewiseMechanics<N, M> + '_> {
        Box::new(self.piece(t))
    }
}

/// Makes a run whose forces or constraints may jump, one smooth piece after the other; returns how many steps were made.
///
/// `make` makes the given steps with the given piece, as [`drive_part`](crate::drive_part) does. Where an imposed velocity
/// jumps, the impulse of the constraints changes the velocity before the next piece begins.
///
/// # Errors
/// [`RunError`] of the part that failed; a jump inside a step is refused before the first step is made.
pub fn piece_by_piece<const N: usize, const M: usize>(
    system: &dyn PiecewiseMechanics<N, M>,
    schedule: &Schedule,
    state: &mut State<N>,
    make: impl FnMut(&dyn PiecewiseMechanics<N, M>, Range<u64>, &mut State<N>) -> Result<Part, RunError>,
) -> Result<u64, RunError> {
    piece_by_piece_from(0, system, schedule, state, make)
}

/// The same for a run that has made `from` steps already and is at `state`, before the impulse of a jump there.
///
/// # Errors
/// As [`piece_by_piece`].
pub fn piece_by_piece_from<const N: usize, const M: usize>(
    from: u64,
    system: &dyn PiecewiseMechanics<N, M>,
    schedule: &Schedule,
    state: &mut State<N>,
    mut make: impl FnMut(&dyn PiecewiseMechanics<N, M>, Range<u64>, &mut State<N>) -> Result<Part, RunError>,
) -> Result<u64, RunError> {
    let (begin, end) = (schedule.t0, schedule.time(schedule.steps));
    let mut made = from;
    for part in pieces(schedule, system.jump_times(begin.min(end), begin.max(end)))? {
        if part.end <= from && from > 0 {
            continue;
        }
        let (first, last) = (schedule.time(part.start), schedule.time(part.end));
        let piece = system.smooth_piece(0.5 * (first + last));
        // Inside a piece there is no impulse.
        if part.start >= from {
            onto_constraint(&*piece, first, state).map_err(|source| RunError {
                step: made + 1,
                time: first,
                source,
            })?;
        }
        let done = make(&*piece, part.start.max(from)..part.end, state)?;
        made = done.made;
        if done.stopped {
            break;
        }
    }
    Ok(made)
}

/// Where a velocity misses its constraints by more than rounding, the impulse of the constraints brings it there: the
/// momentum is projected as at the end of a step, `L_v(q, v) = p + A' mu`, `A v + b = 0`.
///
/// # Errors
/// [`StepError::Newton`] where the constraints do not determine the velocity.
pub fn onto_constraint<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    state: &mut State<N>,
) -> Result<(), StepError> {
    let (q, v) = (*state.q(), *state.v());
    let residual = system.residual(t, &q, &v);
    let (a, b) = system.constraint(t, &q);
    let met = (0..M).all(|k| {
        let size = (0..N).fold(b[k].abs(), |sum, i| sum + (a[k][i] * v[i]).abs());
        residual[k].abs() <= 8.0 * f64::EPSILON * size
    });
    if met {
        return Ok(());
    }
    let v = project(system, t, &q, &v)?;
    state.advance(&[0.0; N], v, None);
    Ok(())
}
