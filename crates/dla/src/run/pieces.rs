use crate::projection::project;
use crate::{AnyState, Mechanics, Mechanism, Part, RunError, Schedule, State, StepError};
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
            return Err(RunError::new(step + 1, schedule.time(step), StepError::Jump { time }));
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

/// A smooth piece of a run: its steps, and their schedule, which numbers nodes from the start of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The steps.
    pub steps: Range<u64>,
    /// The times of the steps.
    pub schedule: Schedule,
}

/// Two times at most this number of steps apart count as one.
const SAME: f64 = 1e-9;

/// The times at which the pieces of a run begin and end (s), in the order of the run.
fn ends(schedule: &Schedule, mut jumps: Vec<f64>) -> Vec<f64> {
    let (begin, end) = (schedule.t0, schedule.time(schedule.steps));
    let order = schedule.step.signum();
    jumps.sort_by(|a, b| f64::total_cmp(&(order * a), &(order * b)));
    let after = |time: f64, before: f64| {
        order * (time - before) > f64::max(SAME * schedule.step.abs(), 8.0 * f64::EPSILON * time.abs())
    };
    let mut ends = vec![begin];
    for time in jumps {
        if ends.last().is_none_or(|last| after(time, *last)) && after(end, time) {
            ends.push(time);
        }
    }
    ends.push(end);
    ends
}

/// Number of steps no longer than `longest` that a piece of this length needs.
fn needed(length: f64, longest: f64) -> u64 {
    (length / longest - SAME).ceil().max(1.0) as u64
}

/// Shares out the steps of a run to pieces of these lengths (s), so that the longest step is as short as possible; `None` if there are
/// fewer steps than pieces.
fn shares(lengths: &[f64], steps: u64) -> Option<Vec<u64>> {
    if steps < lengths.len() as u64 {
        return None;
    }
    let all = |longest: f64| lengths.iter().map(|length| needed(*length, longest)).fold(0, u64::saturating_add);
    let (mut short, mut enough) = (0.0, lengths.iter().copied().fold(0.0, f64::max));
    // To the last bit: the middle of two neighbouring numbers is one of them.
    loop {
        let middle = 0.5 * (short + enough);
        if middle <= short || middle >= enough {
            break;
        }
        *(if all(middle) <= steps { &mut enough } else { &mut short }) = middle;
    }
    let mut shares: Vec<u64> = lengths.iter().map(|length| needed(*length, enough)).collect();
    let left = steps.saturating_sub(shares.iter().sum()) as usize;
    let mut order: Vec<usize> = (0..lengths.len()).collect();
    let step = |k: usize| lengths[k] / shares[k] as f64;
    order.sort_by(|a, b| f64::total_cmp(&step(*b), &step(*a)));
    for k in order.into_iter().cycle().take(left) {
        shares[k] += 1;
    }
    Some(shares)
}

/// The smooth pieces of a run: if every jump is at a node, all with the schedule of the run; else each with equal steps of its own.
///
/// `jumps` are times inside the run (s), in any order. The steps of the run are then shared out to the pieces so that the longest one is as short
/// as possible, and every jump and the end of the run are nodes.
///
/// # Errors
/// [`RunError`] with [`StepError::Jump`] if the run has fewer steps than pieces.
pub fn smooth_pieces(schedule: &Schedule, jumps: Vec<f64>) -> Result<Vec<Piece>, RunError> {
    let strict = match pieces(schedule, jumps.clone()) {
        Ok(ranges) => {
            return Ok(ranges.into_iter().map(|steps| Piece { steps, schedule: *schedule }).collect());
        }
        Err(error) => error,
    };
    let ends = ends(schedule, jumps);
    let lengths: Vec<f64> = ends.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let shares = shares(&lengths, schedule.steps).ok_or(strict)?;
    let mut first = 0;
    let piece = |(pair, share): (&[f64], u64)| {
        let step = (pair[1] - pair[0]) / share as f64;
        let steps = first..first + share;
        first += share;
        let schedule = Schedule { t0: pair[0] - steps.start as f64 * step, step, steps: schedule.steps };
        Piece { steps, schedule }
    };
    Ok(ends.windows(2).zip(shares).map(piece).collect())
}

/// The schedule of a run with these jumps (s) and steps no longer than `longest` (s): the given one if it has a node at every jump, else
/// one over the same time with as many steps as its pieces need, and their mean step.
#[must_use]
pub fn fitted(schedule: &Schedule, longest: f64, jumps: Vec<f64>) -> Schedule {
    if pieces(schedule, jumps.clone()).is_ok() {
        return *schedule;
    }
    let ends = ends(schedule, jumps);
    let needed = ends.windows(2).map(|pair| needed((pair[1] - pair[0]).abs(), longest.abs()));
    let steps = needed.fold(0, u64::saturating_add);
    Schedule { t0: schedule.t0, step: (schedule.time(schedule.steps) - schedule.t0) / steps as f64, steps }
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

/// Makes a run whose forces or constraints may jump, one smooth piece after the other, that has made `from` steps already and is at `state`,
/// before the impulse of a jump there; returns how many steps were made.
///
/// `make` makes the given steps of the given schedule with the given piece, as [`make_steps`](crate::make_steps) does. If an imposed
/// velocity jumps, the impulse of the constraints changes the velocity before the next piece begins.
///
/// # Errors
/// [`RunError`] of the part that failed; a run with fewer steps than pieces is refused before the first step is made.
pub fn piece_by_piece(
    from: u64,
    system: &dyn Mechanism,
    schedule: &Schedule,
    state: &mut AnyState,
    mut make: impl FnMut(&dyn Mechanism, Piece, &mut AnyState) -> Result<Part, RunError>,
) -> Result<u64, RunError> {
    let (begin, end) = (schedule.t0, schedule.time(schedule.steps));
    let mut made = from;
    for Piece { steps, schedule } in smooth_pieces(schedule, system.jump_times(begin.min(end), begin.max(end)))? {
        // The last piece of a finished run is shown without a step, so that observers see the end.
        if from > 0 && steps.end <= from.min(schedule.steps.saturating_sub(1)) {
            continue;
        }
        let first = schedule.time(steps.start);
        let piece = system.smooth_piece(schedule.middle(&steps));
        // Inside a piece there is no impulse.
        if steps.start >= from {
            piece
                .onto_constraint((first, schedule.step), state)
                .map_err(|source| RunError::new(made + 1, first, source))?;
        }
        let done = make(&*piece, Piece { steps: steps.start.max(from)..steps.end, schedule }, state)?;
        made = done.made;
        if done.stopped {
            break;
        }
    }
    Ok(made)
}

/// If a velocity misses its constraints by more than rounding, the impulse of the constraints brings it there: the momentum is projected as
/// at the end of a step, `L_v(q, v) = p + A' mu`, `A v + b = 0`.
///
/// # Errors
/// [`StepError::Newton`] if the constraints do not determine the velocity.
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
