use sleigh::SleighError;
use thiserror::Error;

/// Why a case was not run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum HardCaseError {
    /// There is no such sleigh.
    #[error(transparent)]
    Sleigh(#[from] SleighError),
    /// Something of the case is impossible.
    #[error("{0}")]
    Impossible(&'static str),
}
