use thiserror::Error;

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
