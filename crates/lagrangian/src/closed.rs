use thiserror::Error;

/// Where a step in closed form begins, and what is known there. Whatever is remembered, the step is the same to round-off.
#[derive(Debug)]
pub struct Start<'a, const N: usize> {
    /// The configuration.
    pub q: &'a [f64; N],
    /// The velocity.
    pub v: &'a [f64; N],
    /// The same velocity in the system's basis of admissible velocities, where it is known: either may be read.
    pub xi: Option<[f64; N]>,
    /// What the step before has left, and where this one leaves what the next may need. What a step leaves that fails is of no use.
    pub memory: &'a mut Memory,
}

impl<'a, const N: usize> Start<'a, N> {
    /// Configuration, velocity, and what is remembered.
    #[must_use]
    pub fn new(q: &'a [f64; N], v: &'a [f64; N], memory: &'a mut Memory) -> Self {
        Self { q, v, xi: None, memory }
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
    pub const SIZE: usize = 30;
    /// Nothing yet.
    pub const EMPTY: Self = Self([0.0; Self::SIZE]);

    /// Is of steps of this length from now on, and of this kind.
    #[inline(always)]
    pub fn begin(&mut self, h: f64, kind: f64) {
        (self.0[0], self.0[1]) = (h, kind);
    }

    /// Its first numbers and those after them, to be read where they are used and changed in place.
    ///
    /// Does not compile for more than there is place for.
    #[inline(always)]
    pub fn parts<const A: usize, const B: usize>(&mut self) -> (&mut [f64; A], &mut [f64; B]) {
        const { assert!(A + B + 2 <= Self::SIZE) };
        let [_, _, numbers @ ..] = &mut self.0;
        if let Some((first, others)) = numbers.split_first_chunk_mut()
            && let Some(second) = others.first_chunk_mut()
        {
            return (first, second);
        }
        unreachable!("there is place for them")
    }

    /// Whether a step of this very length has left numbers of this kind.
    #[must_use]
    #[inline(always)]
    pub fn is_of(&self, h: f64, kind: f64) -> bool {
        // As bits, for one branch.
        (self.0[0].to_bits() ^ h.to_bits()) | (self.0[1].to_bits() ^ kind.to_bits()) == 0
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

impl Default for Memory {
    fn default() -> Self {
        Self::EMPTY
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
