use thiserror::Error;

/// Why an assembly could not be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AssemblyError {
    /// An element names a coordinate that is not there, or one twice.
    #[error("the {name} is placed on coordinate {coordinate}, which does not exist or is named twice")]
    Coordinates {
        /// The element's name.
        name: &'static str,
        /// The coordinate.
        coordinate: usize,
    },
    /// An element has too many coordinates.
    #[error("the {name} has {coordinates} coordinates; an element has at most {}", crate::WIDEST)]
    Wide {
        /// The element's name.
        name: &'static str,
        /// How many.
        coordinates: usize,
    },
    /// A number of a model is not what it must be.
    #[error("{what} must be {accepted}, and is {value}")]
    Number {
        /// Which.
        what: &'static str,
        /// What it may be.
        accepted: &'static str,
        /// What it is.
        value: f64,
    },
}
