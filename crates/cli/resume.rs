use crate::error::CliError;
use crate::files::{check_file, write_whole};
use dla::{Checkpoint, CheckpointError, Schedule};
use harness::Method;
use std::io::Write;
use std::path::Path;

/// What tells the run of a scene, of that name and with these contents, with a method from all others.
pub(crate) fn identity(
    (name, contents): (&str, &dyn std::fmt::Debug),
    method: &Method,
    schedule: &Schedule,
) -> Checkpoint {
    let parts = method.substeps().map(|_| ("substep", "yes".to_owned()));
    let run = [
        ("scene", name.to_owned()),
        ("method", method.info().name.to_owned()),
        ("step", schedule.step.to_string()),
        ("steps", schedule.steps.to_string()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        // All the rest: every number of the scene, with every digit.
        ("contents", Checkpoint::fingerprint(&format!("{contents:?}"))),
    ];
    let tolerance = method.is_adaptive().then(|| ("tolerance", method.tolerance().to_string()));
    Checkpoint::of(run.into_iter().chain(parts).chain(tolerance))
}

/// Refuses, before the work begins, a checkpoint that could not be written; one that is resumed may be overwritten.
pub(crate) fn check(path: &Path, resumed: Option<&Path>, force: bool) -> Result<(), CliError> {
    check_file(path, force || resumed == Some(path))
}

/// Reads a checkpoint that must belong to a run.
pub(crate) fn read(path: &Path, identity: &Checkpoint) -> Result<Checkpoint, CliError> {
    let failed = |source: CheckpointError| CliError::Checkpoint { path: path.to_owned(), source };
    let text = std::fs::read(path).map_err(|source| CliError::Read { path: path.to_owned(), source })?;
    let text = String::from_utf8(text).map_err(|_| failed(CheckpointError::NotOne))?;
    let checkpoint = Checkpoint::from_text(&text).map_err(failed)?;
    checkpoint.belongs_to(identity).map_err(failed)?;
    Ok(checkpoint)
}

/// Writes a checkpoint, whole or not at all, over the one before.
pub(crate) fn write(path: &Path, checkpoint: &Checkpoint) -> Result<(), CliError> {
    write_whole(path, true, |file| file.write_all(checkpoint.to_text().as_bytes()))
}
