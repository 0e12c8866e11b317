use super::Memory;

/// Where a step in closed form begins, and what is known there. Whatever is remembered, the step is the same to round-off.
#[derive(Debug)]
pub struct ClosedStart<'a, const N: usize> {
    /// The configuration.
    pub q: &'a [f64; N],
    /// The velocity.
    pub v: &'a [f64; N],
    /// The same velocity in the system's basis of admissible velocities, where it is known: either may be read.
    pub xi: Option<[f64; N]>,
    /// What the step before has left, and where this one leaves what the next may need. What a step leaves that fails is of no use.
    pub memory: &'a mut Memory,
}

impl<'a, const N: usize> ClosedStart<'a, N> {
    /// Configuration, velocity, and what is remembered.
    #[must_use]
    pub fn new(q: &'a [f64; N], v: &'a [f64; N], memory: &'a mut Memory) -> Self {
        Self { q, v, xi: None, memory }
    }
}

/// What a step in closed form gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedStep<const N: usize, const M: usize> {
    /// The increment `q1 - q0`.
    pub increment: [f64; N],
    /// The velocity `v1` at the end, admissible at `q1`.
    pub velocity: [f64; N],
    /// The same velocity as quasi-velocities in the system's basis of admissible velocities at `q1`.
    pub xi: [f64; N],
    /// Impulses of the constraints at the two ends of the step, `A(q0)' impulses[0] + A(q1)' impulses[1]` in all.
    pub impulses: [[f64; M]; 2],
    /// Newton iterations taken.
    pub iterations: u32,
}
