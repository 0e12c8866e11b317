use thiserror::Error;

/// Why a model cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModelError {
    /// A mass, a moment of inertia or a length is not a finite positive number.
    #[error("{quantity} must be a finite positive number, and is {value}")]
    NotPositive {
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A stiffness or a strength is not a finite number, or is below zero.
    #[error("{quantity} must be finite and not negative, and is {value}")]
    Negative {
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number is infinite or not a number.
    #[error("{quantity} must be finite, and is {value}")]
    NotFinite {
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// The kinetic energy of some velocity is not positive.
    #[error("the inertia matrix must be positive definite, and its determinant is {determinant}")]
    NotPositiveDefinite {
        /// Its determinant, where all the leading minors before it are positive.
        determinant: f64,
    },
}

pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64, ModelError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(ModelError::NotPositive { quantity, value }) }
}

pub(crate) fn not_negative(quantity: &'static str, value: f64) -> Result<f64, ModelError> {
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(ModelError::Negative { quantity, value }) }
}

pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64, ModelError> {
    if value.is_finite() { Ok(value) } else { Err(ModelError::NotFinite { quantity, value }) }
}
