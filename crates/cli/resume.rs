use crate::args::CompareArguments;
use crate::error::CliError;
use crate::files::{check_file, check_folder, place, read_text, write_whole};
use crate::{program, terminal};
use dla::{Checkpoint, CheckpointError, Mechanism, Schedule};
use harness::{Method, Progress, Record, Request, Run, Saving};
use scene::AnyScene;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

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

/// The folders in which the runs of a comparison are saved, a checkpoint for each method, and from which they go on.
#[derive(Debug, Default)]
pub(crate) struct Saves {
    to: Option<PathBuf>,
    from: Option<PathBuf>,
    every: u64,
}

impl Saves {
    /// The saves that the arguments ask for. A folder that cannot be written in, or exists already, is refused before the work.
    pub(crate) fn of(arguments: &CompareArguments) -> Result<Self, CliError> {
        let CompareArguments { checkpoint, checkpoint_every, resume, scene, .. } = arguments;
        // A comparison that is resumed goes on saving into its folder.
        let checkpoint = checkpoint.as_ref().or(resume.as_ref());
        if let Some(folder) = resume {
            std::fs::read_dir(folder).map_err(|source| CliError::Read { path: folder.clone(), source })?;
        }
        if let Some(folder) = checkpoint {
            check_folder(folder, scene.force || resume.as_ref() == Some(folder))?;
            std::fs::create_dir_all(folder).map_err(|source| CliError::Write { path: folder.clone(), source })?;
        }
        Ok(Self { to: checkpoint.cloned(), from: resume.clone(), every: *checkpoint_every })
    }

    /// Where to go on after an interruption.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.to.as_deref()
    }

    /// Makes a run of a scene: at once if nothing is to be saved, else from checkpoint to checkpoint.
    pub(crate) fn run(
        &self,
        scene: &AnyScene,
        system: &dyn Mechanism,
        method: &Method,
        request: &Request,
        progress: &mut dyn Progress,
    ) -> Result<Record, CliError> {
        if self.to.is_none() && self.from.is_none() {
            return Ok(Run::of(system, method).progress(progress).timed(request));
        }
        let name = format!("{}.save", method.info().name);
        let identity = identity_of_whole(scene, method, &request.schedule);
        let from = self.from.as_ref().map(|folder| folder.join(&name)).filter(|path| path.exists());
        let read = from.as_ref().map(|path| read(path, &identity)).transpose()?;
        let to = self.to.as_ref().map(|folder| folder.join(&name));
        let mut saver = Saver::new(to.as_deref());
        let mut save = |made: &Checkpoint| saver.save(made);
        let every = to.as_ref().map(|_| self.every);
        let mut saving = Saving { identity: &identity, from: read.as_ref(), every, save: &mut save };
        let outcome = Run::of(system, method).progress(progress).saved(request, &mut saving, None);
        let made = outcome.map_err(|source| CliError::Checkpoint { path: from.unwrap_or_default(), source })?;
        let mut record = made.record;
        saver.outcome()?;
        record.wall_seconds = Run::of(system, method).progress(progress).seconds(request, record.steps);
        Ok(record)
    }
}
