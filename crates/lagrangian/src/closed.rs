use thiserror::Error;

/// Where a step in closed form begins, and what is known there. Whatever it is, the step is the same to round-off.
#[derive(Debug, Clone, Copy)]
pub struct Start<'a, const N: usize> {
    /// The configuration.
    pub q: &'a [f64; N],
    /// The velocity.
    pub v: &'a [f64; N],
    /// The velocity in the system's basis of admissible velocities.
    pub xi: Option<[f64; N]>,
    /// What the step before has left.
    pub memory: &'a Memory,
}

impl<'a, const N: usize> Start<'a, N> {
    /// Configuration and velocity, and nothing else.
    #[must_use]
    pub fn new(q: &'a [f64; N], v: &'a [f64; N]) -> Self {
        Self { q, v, xi: None, memory: &Memory::EMPTY }
    }
}

/// Numbers that a step in closed form leaves to the next one, from which the search there is short.
///
/// They begin with the length of the step, which is zero where there is nothing to remember, and a number that tells whose they are;
/// the others are the system's own affair.
#[derive(Debug, Clone, Copy)]
pub struct Memory(pub [f64; Self::SIZE]);

impl Memory {
    /// As many numbers as any system here remembers.
    pub const SIZE: usize = 26;
    /// Nothing yet.
    pub const EMPTY: Self = Self([0.0; Self::SIZE]);

    /// These numbers, and zeros.
    ///
    /// Does not compile for more than there is place for.
    #[must_use]
    #[inline(always)]
    pub fn of<const K: usize>(numbers: [f64; K]) -> Self {
        const { assert!(K <= Self::SIZE) };
        let mut memory = Self::EMPTY;
        memory.0[..K].copy_from_slice(&numbers);
        memory
    }

    /// Whether there is nothing.
    #[must_use]
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.0[0] == 0.0
    }

    /// Nothing, again.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.0[0] = 0.0;
    }
}

impl PartialEq for Memory {
    /// Nothing is all the same.
    fn eq(&self, other: &Self) -> bool {
        (self.is_empty() && other.is_empty()) || self.0.map(f64::to_bits) == other.0.map(f64::to_bits)
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
    /// What it leaves to the next step.
    pub memory: Memory,
}

/// Why a step in closed form does not exist or was not found.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ClosedStepError {
    /// The equations of the step have no solution on the branch that continues the motion.
    #[error("no solution continues the motion: {quantity} would be {value:e}, and must stay below {bound:e}")]
    NoSolution {
        /// The dimensionless quantity that bounds the step.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// The bound.
        bound: f64,
    },
    /// The iteration did not settle.
    #[error("no convergence in {iterations} iterations, last relative correction {correction:e}")]
    IterationLimit {
        /// Iterations taken.
        iterations: u32,
        /// The last correction, relative.
        correction: f64,
    },
    /// A number became infinite or undefined.
    #[error("{quantity} is not finite")]
    NotFinite {
        /// Which one.
        quantity: &'static str,
    },
}
