//! Which of several solutions of a step continues the motion.

use crate::Mechanics;
use lagrangian::linear::larger;
use lagrangian::{Dual, from_fn, mapped};

/// A solution whose constraint turns by less than this in the step (rad) counts as near its start.
pub(crate) const NEAR: f64 = 1.0;

/// By how much a step with this mean velocity turns the constraint that turns most (rad): the rate times the step, since the two ends do
/// not show whole turns. Zero where no angle turns by more than 1 rad.
#[inline(always)]
pub(crate) fn turn_of<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    q0: &[f64; N],
    v: &[f64; N],
) -> f64 {
    turn(&system.angles(), &from_fn(|i| h * v[i]), |increment| system.rows_along(t0, q0, h, increment))
}

/// By how much an increment of the coordinates turns the constraint that turns most (rad): `rows` gives the matrix `A` and its derivative
/// along the increment.
///
/// Zero where no angle turns by more than 1 rad.
#[inline(always)]
#[must_use]
pub fn turn<const N: usize, const M: usize>(
    angles: &[bool; N],
    increment: &[f64; N],
    rows: impl FnOnce(&[f64; N]) -> [[Dual<f64, 1>; N]; M],
) -> f64 {
    let far = (0..N).any(|i| angles[i] && increment[i].abs() > NEAR);
    if far { turned(rows(increment)) } else { 0.0 }
}

#[cold]
#[inline(never)]
fn turned<const N: usize, const M: usize>(a: [[Dual<f64, 1>; N]; M]) -> f64 {
    let size = |row: [f64; N]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
    // A row that is not affine has no place in `A`.
    let turns = a.map(|row| match size(mapped(&row, |x| x.re)) {
        0.0 => 0.0,
        length => size(mapped(&row, |x| x.eps[0])) / length,
    });
    turns.iter().fold(0.0, |most, turn| larger(most, *turn))
}

/// Numerical continuation in the step length: the solution at the end of the branch that begins with `start` at length zero. `solve` finds
/// the solution near a guess for a part of the length, and gives none where it may be another one; parts are at most `longest`.
#[must_use]
pub fn followed<X: Clone>(start: &X, longest: f64, mut solve: impl FnMut(f64, &mut X) -> Option<()>) -> Option<X> {
    /// Where shorter parts are needed, the branch counts as ended.
    const SHORTEST: f64 = 1.0 / 1024.0;
    // A lower bound on the parts, also where the turn of the whole step is huge or NaN.
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
