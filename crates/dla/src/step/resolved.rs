use crate::{AnyState, StepError};
use lagrangian::linear::larger;

/// One coordinate of a step that was made whole, and again in two halves.
///
/// A method may make a step that has little to do with the motion: the midpoint rule has a solution in a bowl that swings sixteen times
/// within the step, and one for a sleigh that turns a million times. Such a step shows in one of two ways: its halves lead elsewhere; or,
/// if they make the same mistake, the velocities at the nodes do not integrate to the distance. Every coordinate is tested by itself, so
/// that a small coordinate beside large ones is resolved too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Halved {
    /// The velocities before the step, after its first half, after the second, and after the whole.
    pub v: [f64; 4],
    /// The distance by the halves, and by the whole step.
    pub moved: [f64; 2],
}

impl Halved {
    /// The halves and the whole may differ by this part of the largest of the velocities. Of a method of order 2, whose velocities
    /// differ by some `(h/T)^3/16`, that is a step of an eighth of a time constant `T`.
    const AGREEMENT: f64 = 1e-4;
    /// The distances may differ by this part of the distance at the geometric mean of that velocity and the largest of all; they differ
    /// by `(h/T)^2/16` of it: a step of a tenth of a time constant. Where a coordinate turns back, its own velocity is no measure of its
    /// distance.
    const AGREED_WAY: f64 = 5e-4;
    /// Simpson's rule may miss the distance by this part of it. Through a turn by the angle `a` it misses `a^4/2880`, so that methods of
    /// high order may turn by nearly two radians a step.
    const WAY: f64 = 1e-2;
    /// A velocity below this part of the largest of all is not tested.
    const NOTHING: f64 = 1e-12;
    /// A distance of at most this number of roundings of the largest coordinate counts as zero.
    const ROUNDINGS: f64 = 8.0;
    /// A smaller number has lost its digits.
    const LEAST: f64 = 1e-290;

    /// The velocity that counts as zero, in a step of length `h` in which these are the largest coordinate and velocity.
    #[must_use]
    pub fn nothing(h: f64, q: f64, v: f64) -> f64 {
        Self::NOTHING * v + Self::ROUNDINGS * f64::EPSILON * q / h.abs() + Self::LEAST
    }

    /// Whether a step of length `h` resolves the coordinate; `all` is the largest velocity of all coordinates, and
    /// [`nothing`](Self::nothing) the velocity that counts as zero.
    #[must_use]
    pub fn is_resolved(&self, h: f64, all: f64, nothing: f64) -> bool {
        let Self { v: [v0, middle, end, whole], moved: [halves, once] } = *self;
        let largest = self.v.iter().fold(0.0, |largest, v| larger(largest, *v));
        let simpson = (v0 + 4.0 * middle + end) / 6.0;
        (end - whole).abs() <= Self::AGREEMENT * largest + nothing
            && (halves - once).abs() <= (Self::AGREED_WAY * (largest * all).sqrt() + nothing) * h.abs()
            && (once - h * simpson).abs() <= (Self::WAY * largest + nothing) * h.abs()
    }

    /// Whether a step from time `t` to `t + h` that led from `before` to `after` resolves the motion; `make` makes the halves.
    ///
    /// # Errors
    /// [`StepError::Unresolved`] if it does not, and the errors of `make`.
    pub fn resolves(
        (t, h): (f64, f64),
        before: &AnyState,
        after: &AnyState,
        mut make: impl FnMut((f64, f64), &mut AnyState) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let half = 0.5 * h;
        let mut middle = before.clone();
        make((t, half), &mut middle)?;
        let mut end = middle.clone();
        make((t + half, half), &mut end)?;
        let (halves, once) = (end.moved_since(before), after.moved_since(before));
        let coordinate = |i: usize| Self {
            v: [before.v()[i], middle.v()[i], end.v()[i], after.v()[i]],
            moved: [halves[i], once[i]],
        };
        let all: Vec<Self> = (0..halves.len()).map(coordinate).collect();
        let most = |of: &[f64]| of.iter().fold(0.0, |most, x| larger(most, *x));
        let fastest = all.iter().fold(0.0, |fastest, one| larger(fastest, most(&one.v)));
        let nothing = Self::nothing(h, most(&before.unwrapped()), fastest);
        let resolved = all.iter().all(|one| one.is_resolved(h, fastest, nothing));
        if resolved { Ok(()) } else { Err(StepError::Unresolved) }
    }
}
