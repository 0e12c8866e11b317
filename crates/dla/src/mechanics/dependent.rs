use crate::dropping::rank_drop;
use crate::suspect::{suspect_along, suspect_at};
use crate::{Mechanics, NewtonError, Stage, State, StepError};
use lagrangian::linear::larger;
use lagrangian::{RowSpace, Rows, Shown, mapped};
use std::fmt;
use thiserror::Error;

/// Rows of a constraint that depend on one another, in a step that needs independent ones.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub struct Dependent {
    /// The rows that can be left out, and the rows on which they depend.
    pub rows: Rows,
    /// The time (s).
    pub time: f64,
    /// How far the nearest of them lies from the span of the other rows, relative to its size in the kinetic metric.
    pub distance: f64,
    /// The kind of the dependence.
    pub dependency: Dependency,
}

/// How rows depend on one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dependency {
    /// Everywhere nearby, and they ask for the same: the motion is determined, and the method needs independent rows.
    Redundant,
    /// At this place alone: their rank drops, and what the constraints ask for is not continuous there.
    RankDrops,
    /// They ask for different velocities.
    Contradictory,
}

impl fmt::Display for Dependent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rows, time, distance, dependency } = self;
        if rows.count() == 1 {
            write!(f, "{rows} of the constraint vanishes at t = {} s", Shown(*time))?;
        } else {
            write!(
                f,
                "{rows} of the constraint are linearly dependent at t = {} s, to a relative distance of \
                    {distance:.0e}",
                Shown(*time)
            )?;
        }
        f.write_str(match dependency {
            Dependency::Redundant => ": leave out the rows that the others imply, or take a method of the family `dla`",
            Dependency::RankDrops => ": the rank drops there, and the motion beyond is not determined",
            Dependency::Contradictory => ": the rows contradict one another",
        })
    }
}

/// Independent rows that imply all rows, after equations with all rows have failed with `error`.
///
/// # Errors
/// [`StepError::Dependent`] if the rank drops at the place or the rows contradict one another; `error` if the rows are independent, so that
/// something else is degenerate.
#[cold]
#[inline(never)]
pub(crate) fn independent_rows<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    error: StepError,
) -> Result<Rows, StepError> {
    let mut space = system.row_space(t, q, v, RowSpace::<N, M>::ROUNDING);
    let near = space.rank() == M;
    if near {
        // A row that is only nearly dependent fails by the square of its distance.
        space = system.row_space(t, q, v, RowSpace::<N, M>::ROUNDING.sqrt());
        if space.rank() == M {
            return Err(error);
        }
    }
    let found = space.dependence();
    let dependency = if near || !system.rank_is_constant(t, q, v, &space) {
        Dependency::RankDrops
    } else if !system.rows_are_consistent(t, q, v, found) {
        Dependency::Contradictory
    } else {
        return Ok(found.independent);
    };
    Err(Dependent { rows: found.involved, time: t, distance: found.distance, dependency }.into())
}

/// The error of the equations at a place. It names the function that is not finite there, or the rows of the constraint if their rank drops
/// there or they contradict one another.
#[cold]
#[inline(never)]
pub(crate) fn named_at<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    stage: Stage,
    source: NewtonError,
) -> StepError {
    let error = suspect_at(system, t, q, v, StepError::Newton { stage, source });
    if !error.is_singular() {
        return error;
    }
    // Redundant rows show at the beginning of the step already, and are not an error of the place.
    independent_rows(system, t, q, v, error).err().unwrap_or(error)
}

/// The error of the equations of a step, named as by [`named_at`] at the beginning, in the middle or at the end of the step.
#[cold]
#[inline(never)]
pub(crate) fn named_along<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    state: State<N>,
    v: [f64; N],
    source: NewtonError,
) -> StepError {
    let mut error = StepError::Newton { stage: Stage::Increment, source };
    error = suspect_along(system, (t0, h), &state, &v, error);
    for part in [0.0, 0.5, 1.0] {
        if error.is_singular() {
            let q = state.ahead(&mapped(&v, |v| part * h * v));
            error = named_at(system, t0 + part * h, &q, &v, Stage::Increment, source);
        }
    }
    error
}

/// The error of a step. It names the rows of the constraint if they depend on one another at the beginning, or if the motion comes to a
/// place where their rank drops.
#[cold]
#[inline(never)]
pub(crate) fn named<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t, h): (f64, f64),
    state: &State<N>,
    error: StepError,
) -> StepError {
    let unfound =
        matches!(error, StepError::Newton { .. } | StepError::Branch | StepError::Stiff | StepError::Tolerance { .. });
    let at_start = if error.is_singular() { named_rows(system, t, state.q(), state.v(), error) } else { error };
    if matches!(
        at_start,
        StepError::Dependent(Dependent { dependency: Dependency::Redundant | Dependency::Contradictory, .. })
    ) {
        return at_start;
    }
    if (unfound || error.is_singular())
        // Equations become degenerate before the drop is met.
        && let Some(dropped) = rank_drop(system, (t, h), state, 2.0)
    {
        return dropped.into();
    }
    at_start
}

/// The error that names the rows of the constraint that depend on one another at a place; `error` if there are none.
#[cold]
#[inline(never)]
pub(crate) fn named_rows<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    error: StepError,
) -> StepError {
    match independent_rows(system, t, q, v, error) {
        Err(error) => error,
        Ok(_) => dependent_at(system, t, q, v, Dependency::Redundant),
    }
}

fn dependent_at<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    dependency: Dependency,
) -> StepError {
    let space = system.row_space(t, q, v, RowSpace::<N, M>::ROUNDING);
    let found = space.dependence();
    Dependent { rows: found.involved, time: t, distance: found.distance, dependency }.into()
}

/// Checks that the rows that a step left out hold at its end, too.
///
/// # Errors
/// [`StepError::Dependent`] names the rows that do not hold, with all rows on which they depended.
#[cold]
#[inline(never)]
pub(crate) fn rows_left_out<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t1: f64,
    q1: &[f64; N],
    v1: &[f64; N],
    kept: Rows,
) -> Result<(), StepError> {
    let rows = system.reaction_rows(t1, q1, v1);
    let (_, b) = system.constraint(t1, q1);
    let slip = system.residual(t1, q1, v1);
    // Every row relative to its own size; rounding comes from the terms of the largest row.
    let size = |k: usize| rows[k].iter().fold(0.0, |m, x| larger(m, *x));
    let terms = (0..M)
        .filter(|k| size(*k) > 0.0)
        .fold(0.0, |m, k| larger(m, (0..N).fold(b[k].abs(), |sum, i| sum + (rows[k][i] * v1[i]).abs()) / size(k)));
    let bound = 4.0 * RowSpace::<N, M>::ROUNDING * terms;
    let positions = system.position_misses(t1, q1);
    let missed: Rows = (0..M)
        .filter(|k| !kept.contains(*k))
        .filter(|k| {
            // Twice its rounding is allowed to a position, since only the kept rows were solved for.
            let off = positions.and_then(|g| g[*k]).is_some_and(|g| {
                let rounding: f64 = (0..N).map(|i| (g.eps[i] * q1[i]).abs()).sum();
                g.re.abs() > RowSpace::<N, M>::ROUNDING * rounding
            });
            slip[*k].abs() > bound * size(*k) || off
        })
        .collect();
    if missed.is_empty() {
        return Ok(());
    }
    Err(Dependent {
        rows: missed.and(kept),
        time: t1,
        distance: missed.iter().fold(0.0, |m, k| larger(m, slip[k] / (terms * size(k)))),
        dependency: Dependency::Contradictory,
    }
    .into())
}
