use thiserror::Error;

/// Why a sleigh or its motion cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SleighError {
    /// A mass or a moment of inertia is not a finite positive number.
    #[error("{quantity} must be a finite positive number, and is {value:?}")]
    NotPositive {
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number is infinite or not a number.
    #[error("{quantity} must be finite, and is {value:?}")]
    NotFinite {
        /// Which parameter, state variable or derived quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A coefficient is negative or not finite.
    #[error("{quantity} must be a finite number and not negative, and is {value:?}")]
    Negative {
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A table is not a function of time.
    #[error("the table is not a function of time: {problem}")]
    Table {
        /// What is wrong with it.
        problem: String,
    },
    /// A text is not a formula in the time.
    #[error("the text is not a function of the time `t`: {problem}")]
    Formula {
        /// What is wrong with it.
        problem: String,
    },
    /// What is wanted needs a system of a few coordinates, and this is a train of many.
    #[error(
        "the scene has `trailers`, and this command has no trains: `run`, `compare` and `precision` have trains, with dla, dla4, dla6 and dla8"
    )]
    Train,
    /// A path cannot be followed.
    #[error("the path cannot be followed: {problem}")]
    Path {
        /// What is wrong with it.
        problem: String,
    },
}

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
