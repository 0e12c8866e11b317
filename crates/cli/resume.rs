use crate::error::CliError;
use crate::files::{check_file, place, read_text, write_whole};
use crate::{program, terminal};
use dla::{Checkpoint, CheckpointError, Schedule};
use harness::Method;
use scene::AnyScene;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// The largest checkpoint that is read (bytes): ten times the checkpoint of a train of a hundred thousand trailers.
const LARGEST: u64 = 1 << 28;

/// Identifies the run of a scene by a method. A longer run begins with the shorter one, unless something jumps: the steps of a smooth piece
/// are chosen for its length, so that a longer run has others after the last jump.
pub(crate) fn identity(scene: &AnyScene, method: &Method, schedule: &Schedule) -> Checkpoint {
    let jumps = match scene {
        AnyScene::Sleigh(scene) => scene.jumps().is_ok_and(|jumps| !jumps.is_empty()),
        AnyScene::Text(scene) => !scene.jumps().is_empty(),
    };
    if jumps {
        return identity_of_whole(scene, method, schedule);
    }
    let mut scene = scene.clone();
    scene.run_mut().duration = 0.0;
    Checkpoint::of(pairs(&scene, method, schedule))
}

/// As [`identity`], for a run whose record also depends on its length.
pub(crate) fn identity_of_whole(scene: &AnyScene, method: &Method, schedule: &Schedule) -> Checkpoint {
    Checkpoint::of(pairs(scene, method, schedule).chain([("steps", schedule.steps.to_string())]))
}

fn pairs(scene: &AnyScene, method: &Method, schedule: &Schedule) -> impl Iterator<Item = (&'static str, String)> {
    let contents = match scene {
        AnyScene::Sleigh(scene) => format!("{scene:?}"),
        AnyScene::Text(scene) => format!("{:?}", (&scene.words, &scene.start, &scene.run)),
    };
    let parts = method.substeps().map(|_| ("substep", "yes".to_owned()));
    let run = [
        ("scene", scene.name().to_owned()),
        ("method", method.info().name.to_owned()),
        ("step", schedule.step.to_string()),
        ("version", program::version()),
        ("instructions", program::instructions()),
        // All the rest: every number of the scene, with every digit.
        ("contents", Checkpoint::fingerprint(&contents)),
    ];
    let tolerance = method.is_adaptive().then(|| ("tolerance", method.tolerance().to_string()));
    run.into_iter().chain(parts).chain(tolerance)
}

/// Refuses, before the work begins, a checkpoint that could not be written; one that is resumed may be overwritten.
pub(crate) fn check(path: &Path, resumed: Option<&Path>, force: bool) -> Result<(), CliError> {
    check_file(path, force || resumed.is_some_and(|resumed| place(resumed) == place(path)))
}

/// Reads a checkpoint that must belong to a run.
pub(crate) fn read(path: &Path, identity: &Checkpoint) -> Result<Checkpoint, CliError> {
    let failed = |source: CheckpointError| CliError::Checkpoint { path: path.to_owned(), source };
    let text = match read_text(path, LARGEST) {
        Err(error) if error.kind() == ErrorKind::InvalidData => return Err(failed(CheckpointError::NotOne)),
        text => text.map_err(|source| CliError::Read { path: path.to_owned(), source })?,
    };
    let checkpoint = Checkpoint::from_text(&text).map_err(failed)?;
    checkpoint.belongs_to(identity).map_err(failed)?;
    Ok(checkpoint)
}

/// Writes the checkpoints of a run to a file, if there is one. A save that fails after a good one is warned of at once; the next save is
/// tried all the same.
#[derive(Debug)]
pub(crate) struct Saver<'a> {
    path: Option<&'a Path>,
    failed: Option<CliError>,
}

impl<'a> Saver<'a> {
    /// Saves to the file `path`.
    pub(crate) fn new(path: Option<&'a Path>) -> Self {
        Self { path, failed: None }
    }

    /// Saves a checkpoint.
    pub(crate) fn save(&mut self, made: &Checkpoint) {
        let Some(path) = self.path else { return };
        let failed = write(path, made).err();
        // Once: a save that fails for lack of room fails each time until there is room.
        if let (None, Some(error)) = (&self.failed, &failed) {
            terminal::say("warning", &format!("{error}; the run goes on, and the next save is tried"));
        }
        self.failed = failed;
    }

    /// Whether the run is saved as far as it came.
    pub(crate) fn outcome(self) -> Result<(), CliError> {
        self.failed.map_or(Ok(()), Err)
    }
}

/// Writes a checkpoint, whole or not at all, over the one before.
fn write(path: &Path, checkpoint: &Checkpoint) -> Result<(), CliError> {
    write_whole(path, true, |file| file.write_all(checkpoint.to_text().as_bytes()))
}
