use lagrangian::Shown;
use thiserror::Error;

/// Why a step in closed form does not exist or was not found.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ClosedStepError {
    /// The equations of the step have no solution on the branch that continues the motion.
    #[error("the step is too long: {quantity} would be {}, and must stay below {}", Shown(*value), Shown(*bound))]
    NoSolution {
        /// The dimensionless quantity that bounds the step.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// The bound.
        bound: f64,
    },
    /// The iteration did not settle.
    #[error("no convergence in {iterations} iterations; the last relative correction is {correction:.2e}")]
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
