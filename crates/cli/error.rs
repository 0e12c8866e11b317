use crate::terminal;
use dla::{CheckpointError, RecommendError};
use harness::MethodError;
use harness::analysis::EquilibriumError;
use report::ReportError;
use scene::SceneError;
use std::path::PathBuf;
use thiserror::Error;

/// The exit code of a command that a signal ended: 128 and the number of SIGINT, as shells have it.
pub(crate) const INTERRUPTED: u8 = 130;

/// Why a command did not do what it was asked. `main` puts `error: ` in front of each.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Sweep(#[from] scene::SweepError),
    #[error("{0}")]
    Method(#[from] MethodError),
    #[error("the scene: {0}")]
    Sleigh(#[from] sleigh::SleighError),
    #[error("the scene: {0}")]
    Build(#[from] scene::BuildError),
    #[error("unknown case `{name}`{}; the cases are {names}", nearest.as_ref().map_or_else(String::new, |n| format!(", did you mean `{n}`?")))]
    Case { name: String, nearest: Option<String>, names: String },
    #[error("{} exists already; --force overwrites it", path.display())]
    Exists { path: PathBuf },
    #[error("{}: rows are written as .csv, .jsonl, .npz or .parquet; the ending of the name or --format chooses the \
        format", path.display())]
    Ending { path: PathBuf },
    #[cfg(not(feature = "parquet"))]
    #[error(
        "{}: this program was built without Parquet; `cargo build --release --features parquet` builds a program \
            with Parquet",
        path.display()
    )]
    WithoutParquet { path: PathBuf },
    #[error("{}: accepted are numbers (.csv) and a picture (.svg), by the ending of the name", path.display())]
    ChartEnding { path: PathBuf },
    /// The request makes no sense, or does not fit this scene or method.
    #[error("{0}")]
    Request(String),
    /// More than fits into memory.
    #[error("{0}")]
    Memory(String),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("cannot write {}: in the folder {}: {source}", path.display(), folder.display())]
    Folder { path: PathBuf, folder: PathBuf, source: std::io::Error },
    /// Another process writes the same output.
    #[error("{}: another process is writing {}: wait for its end, or choose another --out", path.display(), out.display())]
    Busy { path: PathBuf, out: PathBuf },
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{}: {source}", path.display())]
    Checkpoint { path: PathBuf, source: CheckpointError },
    #[error("--tolerance: {0}")]
    Tolerance(Box<RecommendError>),
    #[error("{}: {problem}; accepted is JSON, {{\"points\": [{{\"method\", \"step\" or \"tolerance\", \"steps\", \"error\", \"wall_seconds\"}}]}}", path.display())]
    Points { path: PathBuf, problem: String },
    #[error("steady motions: {0}")]
    Equilibria(#[from] EquilibriumError),
    #[error(
        "--method: noslip equilibria has no derivatives of the steps of {method}; accepted are the family dla and \
            rk4"
    )]
    NotDifferentiated { method: &'static str },
    #[error(
        "the scene {scene} has no `tracer`: noslip phase measures the loops of a tracer, as in `noslip phase \
        planimeter`"
    )]
    WithoutTracer { scene: String },
    #[error("cannot write to standard output: {0}")]
    Output(std::io::Error),
    #[error("the report: {0}")]
    Report(ReportError),
    /// Ctrl-C; what was done has been shown.
    #[error("interrupted: {made}{}", resume.as_ref().map_or_else(String::new, |d| format!("; --resume {} continues", d.display())))]
    Interrupted { made: String, resume: Option<PathBuf> },
    /// The computation failed; what was reached has been shown.
    #[error("{}", .0.join("\nerror: "))]
    Computation(Vec<String>),
}

impl CliError {
    /// All failures of a computation, if there are any.
    pub(crate) fn of_failures(failures: impl IntoIterator<Item = String>) -> Result<(), Self> {
        let failures: Vec<String> = failures.into_iter().collect();
        if failures.is_empty() { Ok(()) } else { Err(Self::Computation(failures)) }
    }

    /// 1: the computation failed, or what it gave could not be written. 2: the request was wrong.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted { .. } => INTERRUPTED,
            Self::Write { .. } | Self::Folder { .. } | Self::Output(_) | Self::Report(_) | Self::Computation(_) => 1,
            Self::Tolerance(error) if !matches!(**error, RecommendError::Request { .. }) => 1,
            // A search without a result is no fault of the request.
            Self::Equilibria(
                EquilibriumError::NoneFound { .. } | EquilibriumError::Singular(_) | EquilibriumError::NotFinite,
            ) => 1,
            _ => 2,
        }
    }
}

/// The outcome of work that may have been interrupted; an earlier failure is printed.
pub(crate) fn unless_interrupted(
    interrupted: Option<String>,
    resume: Option<PathBuf>,
    outcome: Result<(), CliError>,
) -> Result<(), CliError> {
    let Some(made) = interrupted else { return outcome };
    if let Err(error) = outcome {
        terminal::say("error", &error);
    }
    Err(CliError::Interrupted { made, resume })
}
