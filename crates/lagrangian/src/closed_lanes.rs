use crate::Abreast;

/// A system whose midpoint discrete Lagrange-d'Alembert map is known in a closed form that many trajectories can go through at
/// once: what [`System::closed_step`](crate::System::closed_step) is for one.
///
/// A step has `P` numbers of the system and of its length, the quasi-velocities, and a *frame* of `F` numbers that a step
/// leaves to the next one: such as sine and cosine of a heading, which a rotation gives cheaper than the angle does.
pub trait ClosedLanes<const N: usize, const M: usize, const P: usize, const F: usize> {
    /// The numbers of a step of length `h` (s).
    fn prepared(&self, h: f64) -> [f64; P];

    /// The frame at a configuration, after the frame of the step that led there; before the first step that is NaN.
    fn frame(q: &[f64; N], before: &[f64; F]) -> [f64; F];

    /// One step. A step that is not `WIDE` is quicker, and good only for small changes.
    fn step<const WIDE: bool, const R: usize>(
        prepared: &[Abreast<R>; P],
        xi: &[Abreast<R>; N],
        frame: &[Abreast<R>; F],
    ) -> ClosedLaneStep<R, N, M, F>;
}

/// What a step of [`ClosedLanes`] gives; the quantities are those of [`ClosedStep`](crate::ClosedStep).
#[derive(Debug, Clone, Copy)]
pub struct ClosedLaneStep<const R: usize, const N: usize, const M: usize, const F: usize> {
    /// The increment `q1 - q0`.
    pub increment: [Abreast<R>; N],
    /// The quasi-velocities at the end.
    pub xi: [Abreast<R>; N],
    /// The frame at the end.
    pub frame: [Abreast<R>; F],
    /// The impulses of the constraints over the step, both ends together.
    pub impulse: [Abreast<R>; M],
    /// Whether the step is good to rounding.
    pub good: [bool; R],
}
