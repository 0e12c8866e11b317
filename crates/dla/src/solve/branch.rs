//! Which of several solutions of a step continues the motion.

use crate::{Mechanics, StepError};
use lagrangian::linear::{larger, largest};
use lagrangian::{Dual, from_fn};
use std::f64::consts::PI;

/// A solution whose constraint turns by less than this in the step (rad) counts as near its start.
pub(crate) const NEAR: f64 = 1.0;

/// The error of a solution that is not shown to continue the motion. If the derivatives are the same there and at the start, the equations
/// are linear and have no other solution.
#[cold]
pub(crate) fn unfollowed(derivatives: [&[f64]; 2]) -> StepError {
    /// Relative to the largest of them.
    const SAME: f64 = 1e-9;
    let [there, start] = derivatives;
    let same = there.iter().zip(start).all(|(x, y)| (x - y).abs() <= SAME * largest(start));
    if same { StepError::Stiff } else { StepError::Branch }
}

/// The angle by which a step with this mean velocity turns the constraint that turns most (rad): the rate times the step, since the two
/// ends do not show whole turns. Zero if no angle turns by more than 1 rad.
#[inline(always)]
pub(crate) fn turn_of<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    q0: &[f64; N],
    v: &[f64; N],
) -> f64 {
    let increment = from_fn(|i| h * v[i]);
    turn(&system.angles(), &increment, || system.rows_along(t0, q0, h, &increment))
}

/// Refuses a step in which the velocity `v0` at its beginning would turn the constraint by half a turn or more: a rule that looks at the
/// rows at a few nodes cannot tell such a turn from a smaller one the other way round, and has a solution that loses it.
///
/// # Errors
/// [`StepError::Turn`] with the angle that turns most.
#[inline(always)]
pub(crate) fn tells_turn<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    q0: &[f64; N],
    v0: &[f64; N],
) -> Result<(), StepError> {
    let turn = turn_of(system, (t0, h), q0, v0);
    // The equations of the step report a turn that is not a number.
    if turn < PI || !turn.is_finite() { Ok(()) } else { Err(turned_by(system, (t0, h), q0, v0, turn)) }
}

/// The error of a step with too large a turn, with the coordinate that alone turns the constraint most.
#[cold]
#[inline(never)]
fn turned_by<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    q0: &[f64; N],
    v0: &[f64; N],
    turn: f64,
) -> StepError {
    let alone = |i: usize| {
        let increment = from_fn(|j| if j == i { h * v0[i] } else { 0.0 });
        turned(&system.rows_along(t0, q0, h, &increment))
    };
    let coordinate = (0..N).fold(0, |most, i| if alone(i) > alone(most) { i } else { most });
    StepError::Turn { coordinate, turn, step: h.abs() }
}

/// The angle by which an increment of the coordinates turns the constraint that turns most (rad): `rows` gives the rows of `A` with their
/// derivatives along the increment.
///
/// Zero if no angle turns by more than 1 rad.
#[inline(always)]
#[must_use]
pub fn turn<Rows: AsRef<[Row]>, Row: AsRef<[Dual<f64, 1>]>>(
    angles: &[bool],
    increment: &[f64],
    rows: impl FnOnce() -> Rows,
) -> f64 {
    let far = angles.iter().zip(increment).any(|(angle, turn)| *angle && turn.abs() > NEAR);
    if far { turned(rows().as_ref()) } else { 0.0 }
}

#[cold]
#[inline(never)]
fn turned<Row: AsRef<[Dual<f64, 1>]>>(rows: &[Row]) -> f64 {
    let size = |row: &Row, of: fn(&Dual<f64, 1>) -> f64| row.as_ref().iter().map(|x| of(x).powi(2)).sum::<f64>().sqrt();
    // A row that is not affine has no place in `A`.
    let turns = rows.iter().map(|row| match size(row, |x| x.re) {
        0.0 => 0.0,
        length => size(row, |x| x.eps[0]) / length,
    });
    turns.fold(0.0, larger)
}

/// Numerical continuation in the step length: the solution at the end of the branch that begins with `start` at length zero. `solve` finds
/// the solution near a guess for a part of the length, and returns `None` if that may be a solution of another branch. Parts are at most
/// `longest`.
#[must_use]
pub fn followed<X: Clone>(start: &X, longest: f64, mut solve: impl FnMut(f64, &mut X) -> Option<()>) -> Option<X> {
    /// If shorter parts are needed, the branch counts as ended.
    const SHORTEST: f64 = 1.0 / 1024.0;
    // A lower bound on the parts, even if the turn of the whole step is huge or NaN.
    let longest = longest.max(SHORTEST);
    let (mut x, mut reached, mut part) = (start.clone(), 0.0, f64::min(longest, 0.25));
    while reached < 1.0 {
        let (mut guess, next) = (x.clone(), f64::min(1.0, reached + part));
        if solve(next, &mut guess).is_some() {
            (x, reached, part) = (guess, next, f64::min(longest, 2.0 * part));
        } else if part > SHORTEST {
            part *= 0.5;
        } else {
            return None;
        }
    }
    Some(x)
}
