//! What a parameter must be.

use crate::SleighError;

/// The numbers, if all are finite.
pub(crate) fn finite<const K: usize>(quantity: &'static str, numbers: [f64; K]) -> Result<[f64; K], SleighError> {
    match numbers.iter().find(|x| !x.is_finite()) {
        Some(value) => Err(SleighError::NotFinite { quantity, value: *value }),
        None => Ok(numbers),
    }
}

/// The number, if it is finite and positive.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64, SleighError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(SleighError::NotPositive { quantity, value }) }
}

/// The number, if it is finite and not negative.
pub(crate) fn not_negative(quantity: &'static str, value: f64) -> Result<f64, SleighError> {
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(SleighError::Negative { quantity, value }) }
}
