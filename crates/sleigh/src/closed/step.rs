use super::Memory;

/// The start of a step in closed form. The numbers of `memory` change the step by round-off at most.
#[derive(Debug)]
pub struct ClosedStart<'a, const N: usize> {
    /// The configuration.
    pub q: &'a [f64; N],
    /// The velocity.
    pub v: &'a [f64; N],
    /// The same velocity in the system's basis of admissible velocities, if known. A step may read either.
    pub xi: Option<[f64; N]>,
    /// Numbers left by the step before, replaced by numbers for the next step. After a step that fails they are of no use.
    pub memory: &'a mut Memory,
}

impl<'a, const N: usize> ClosedStart<'a, N> {
    /// A start with this configuration, velocity and memory.
    #[must_use]
    pub fn new(q: &'a [f64; N], v: &'a [f64; N], memory: &'a mut Memory) -> Self {
        Self { q, v, xi: None, memory }
    }
}

/// The result of a step in closed form.
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
