use crate::{NewtonError, StepError};
use lagrangian::Shown;
use thiserror::Error;

/// Why a step has no derivative.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SensitivityError {
    /// The step itself failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The method or the system cannot be differentiated.
    #[error("{reason}")]
    Unsupported {
        /// The reason.
        reason: &'static str,
    },
    /// The equations of the step, restated, were not solved.
    #[error("the derivative of the step: {0}")]
    Equations(#[source] NewtonError),
    /// The equations of the step have another solution than the one that the method took.
    #[error(
        "the step of the method does not satisfy the equations that the derivative is taken of: their relative \
            residual is {defect:.2e}; choose a shorter step"
    )]
    OtherSolution {
        /// The largest difference of configurations or velocities, relative.
        defect: f64,
    },
}

/// A run with tangents that ended early; state and tangents are at the last good node.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("step {step}, from t = {} s: {source}", Shown(*time))]
pub struct TangentRunError {
    /// The number of the failed step, from 1.
    pub step: u64,
    /// The time at which it began (s).
    pub time: f64,
    /// The error of the step.
    #[source]
    pub source: SensitivityError,
}
