use thiserror::Error;

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
