use crate::args::CompareArguments;
use crate::error::CliError;
use crate::files::check_folder;
use crate::resume;
use dla::{Checkpoint, Mechanism};
use harness::{Method, Progress, Record, Request, Saving, run_saved, timed};
use scene::AnyScene;
use std::path::{Path, PathBuf};

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
            return Ok(harness::run(system, method, request, progress));
        }
        let name = format!("{}.save", method.info().name);
        let identity = resume::identity_of_whole(scene, method, &request.schedule);
        let from = self.from.as_ref().map(|folder| folder.join(&name)).filter(|path| path.exists());
        let read = from.as_ref().map(|path| resume::read(path, &identity)).transpose()?;
        let to = self.to.as_ref().map(|folder| folder.join(&name));
        let mut saver = resume::Saver::new(to.as_deref());
        let mut save = |made: &Checkpoint| saver.save(made);
        let every = to.as_ref().map(|_| self.every);
        let mut saving = Saving { identity: &identity, from: read.as_ref(), every, save: &mut save };
        let outcome = run_saved(system, method, request, &mut saving, None, progress);
        let mut record = outcome.map_err(|source| CliError::Checkpoint { path: from.unwrap_or_default(), source })?;
        saver.outcome()?;
        record.wall_seconds = timed(system, method, request, record.steps, progress);
        Ok(record)
    }
}
