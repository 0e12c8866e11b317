//! First derivatives of steps and runs.

mod composition;
mod derivative;
mod dla;
mod equations;
mod error;
mod gauss;
mod gni;
mod implicit;
mod impulse;
mod linear;
mod reduced;
mod run;
mod step;

pub use derivative::{StepDerivative, Tangent, Variation};
pub use equations::{Differentiable, StepEquations, StepStart, StepUnknowns};
pub(crate) use equations::{NO_BASIS, advanced, constrained, difference, dimension, product};
pub use error::{SensitivityError, TangentRunError};
pub use reduced::{ReducedDerivative, ReducedVariation};
pub use step::Sensitivity;
