use harness::{MethodError, report::ReportError};
use scene::SceneError;
use std::path::PathBuf;
use std::process::ExitCode;
use thiserror::Error;

/// Why a command did not do what it was asked.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("error: {0}")]
    Method(#[from] MethodError),
    #[error("error: {} exists already; --force overwrites it", path.display())]
    Exists { path: PathBuf },
    #[error("error: {}: a trajectory is written as .csv or .npz, by the ending of its name", path.display())]
    Ending { path: PathBuf },
    #[error("error: cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("error: cannot write to standard output: {0}")]
    Output(std::io::Error),
    #[error("error: the report: {0}")]
    Report(ReportError),
    /// The computation failed; what was reached has been shown.
    #[error("error: {0}")]
    Computation(String),
    #[error("nobody reads the output")]
    ReaderGone,
}

impl CliError {
    /// 1: the computation failed, or what it gave could not be written. 2: the request was wrong.
    pub(crate) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Scene(_) | Self::Method(_) | Self::Exists { .. } | Self::Ending { .. } => ExitCode::from(2),
            Self::Report(ReportError::Exists { .. }) => ExitCode::from(2),
            Self::Write { .. } | Self::Output(_) | Self::Report(_) | Self::Computation(_) => ExitCode::FAILURE,
            Self::ReaderGone => ExitCode::SUCCESS,
        }
    }
}
