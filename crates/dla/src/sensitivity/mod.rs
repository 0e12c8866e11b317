//! First derivatives of steps and runs.

mod derivative;
mod equations;
mod error;
mod implicit;
mod linear;
mod methods;
mod reduced;
mod run;
mod step;

pub use derivative::{StepDerivative, Tangent, Variation};
pub use equations::{Differentiable, StepEquations, StepStart, StepUnknowns};
pub use error::{SensitivityError, TangentRunError};
pub use reduced::{ReducedDerivative, ReducedVariation};
pub use step::Sensitivity;
