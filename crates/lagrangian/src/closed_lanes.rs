use std::ops::{Add, Div, Mul, Neg, Sub};

/// Numbers of some trajectories side by side, as [`simd::Pack`](crate::simd::Pack) is.
///
/// Less than a [`Scalar`](crate::Scalar): a constant must be made like another number, whose registers it takes.
pub trait Side:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The same constant for all.
    #[must_use]
    fn like(self, x: f64) -> Self;

    /// `self * factor + term`, rounded once where the machine does so.
    #[must_use]
    fn mul_add(self, factor: Self, term: Self) -> Self;

    /// Sines and cosines (rad).
    #[must_use]
    fn sin_cos(self) -> (Self, Self);
}

/// A system whose midpoint discrete Lagrange-d'Alembert map is known in a closed form that many trajectories can go through at
/// once: what [`System::closed_step`](crate::System::closed_step) is for one.
///
/// A step has `P` numbers of the system and of its length, the quasi-velocities, and a *frame* of `F` numbers that a step
/// leaves to the next one: such as sine and cosine of a heading, which a rotation gives cheaper than the angle does. Nothing in
/// it branches.
pub trait ClosedLanes<const N: usize, const M: usize, const P: usize, const F: usize> {
    /// The numbers of a step of length `h` (s).
    fn prepared(&self, h: f64) -> [f64; P];

    /// In which unit a step counts the impulse of each constraint (N s): factors that are the same in every step are left to the end
    /// of a run.
    fn impulse_units(&self) -> [f64; M];

    /// The frame at a configuration, after the frame of the step that led there; before the first step that is NaN.
    fn frame<S: Side>(q: &[S; N], before: &[S; F]) -> [S; F];

    /// Up to which sizes of its [doubts](ClosedLaneStep::doubts) a step is good.
    fn bounds<const WIDE: bool>() -> [f64; 2];

    /// One step. A step that is not `WIDE` is quicker, and good only for small changes.
    fn step<const WIDE: bool, S: Side>(prepared: &[S; P], xi: &[S; N], frame: &[S; F]) -> ClosedLaneStep<S, N, M, F>;
}

/// What a step of [`ClosedLanes`] gives; the quantities are those of [`ClosedStep`](crate::ClosedStep).
#[derive(Debug, Clone, Copy)]
pub struct ClosedLaneStep<S, const N: usize, const M: usize, const F: usize> {
    /// The increment `q1 - q0`.
    pub increment: [S; N],
    /// The quasi-velocities at the end.
    pub xi: [S; N],
    /// The frame at the end.
    pub frame: [S; F],
    /// The impulses of the constraints over the step, both ends together, in their [units](ClosedLanes::impulse_units).
    pub impulse: [S; M],
    /// The step is good to rounding where neither of these is beyond its [bound](ClosedLanes::bounds) in size,
    pub doubts: [S; 2],
    /// and this one of a wide step is positive: quick steps take over from wide ones.
    pub positive: S,
}
