use super::told;
use crate::args::RunArguments;
use crate::compare::unless_interrupted;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::progress::Interruptible;
use crate::trajectory_file::{self, Format};
use crate::{inspect, json, progress, resume, substeps, table, terminal};
use dla::{Checkpoint, Trajectory};
use harness::{Method, Progress, Record, Request, Saving, recommend, run_saved, run_watched};
use scene::{StartedText, TextMechanics, TextScene, with_text};
use std::path::Path;

/// `noslip run` of a system of text.
pub(crate) fn run(
    arguments: &RunArguments,
    scene: &TextScene,
    method: &Method,
    out: Option<(&Path, Format)>,
) -> Result<(), CliError> {
    if !arguments.event.is_empty() || !arguments.until.is_empty() {
        let problem = "--event and --until look for quantities of a sleigh, which a system of text does not have";
        return Err(CliError::Request(problem.to_owned()));
    }
    told::note_moves(scene);
    let run = Run { arguments, scene, method, out };
    with_text!(super::system(scene)?, started => run.make(&started))
}

struct Run<'a> {
    arguments: &'a RunArguments,
    scene: &'a TextScene,
    method: &'a Method,
    out: Option<(&'a Path, Format)>,
}

/// A run that was made, with the nodes that are to be written, and what else went wrong.
type Made<const N: usize, const M: usize> = (Record<N>, Option<Trajectory<N, M>>, Result<(), CliError>);

impl Run<'_> {
    fn make<const N: usize, const M: usize>(&self, started: &StartedText<N, M>) -> Result<(), CliError> {
        let RunArguments { tolerance, scene: flags, every, .. } = self.arguments;
        let (system, q, v) = (&*started.system, started.q, started.v);
        let mut schedule = inspect::steps_of(&self.scene.run);
        if let Some(tolerance) = tolerance {
            // Of the method itself: parts would make any step look good enough.
            let found = recommend(system, &self.method.undivided(), (q, v), self.scene.run.duration, *tolerance);
            let found = found.map_err(|error| CliError::Tolerance(Box::new(error)))?;
            schedule.step = found.step;
            schedule.steps = found.steps;
            if self.out.is_some() {
                trajectory_file::check_size(schedule.steps, *every)?;
            }
        }
        let interrupt = Interrupt::listen();
        let bar = progress::bar(self.method.info().name, schedule.steps);
        let mut progress = Interruptible { bar, interrupt: &interrupt };
        let made = self.made(system, &Request { schedule, q, v, samples: 1 }, &mut progress);
        progress.bar.finish_and_clear();
        let (record, trajectory, warning) = made?;

        let written = self.out.zip(trajectory).map_or(Ok(()), |((path, format), trajectory)| {
            let columns = told::columns(system, trajectory.nodes());
            trajectory_file::write_columns(&columns, path, format, flags.force)
        });
        let model = system.model();
        // What was computed is shown even where its file could not be written.
        if flags.json {
            let end = told::json(model, record.t, &record.q, &record.v);
            let mut object = json::record_of(&self.scene.name, &record, &end);
            substeps::add_json(&mut object, &record);
            terminal::print_json(&object)?;
        } else {
            let file = self.out.and_then(|(path, _)| written.is_ok().then_some(path));
            let end = told::lines(model, record.t, &record.q, &record.v);
            let name = (self.scene.title.as_str(), self.scene.name.as_str());
            terminal::print(&(table::one_run_of(name, &record, &end, file) + &substeps::told(&record)))?;
        }
        let computed = CliError::of_failures(substeps::failure(&record));
        if let (Err(_), Err(error)) = (&computed, &written) {
            terminal::say("error", error);
        }
        let made = record.interrupted.then(|| format!("the run is made up to t = {} s", table::number(record.t)));
        unless_interrupted(made, self.arguments.checkpoint.clone(), computed.and(written).and(warning))
    }

    /// At once, or in parts that are saved, or from a part that was.
    fn made<const N: usize, const M: usize>(
        &self,
        system: &dyn TextMechanics<N, M>,
        request: &Request<N>,
        progress: &mut dyn Progress,
    ) -> Result<Made<N, M>, CliError> {
        let RunArguments { checkpoint, checkpoint_every, resume: from, scene, event_samples, .. } = self.arguments;
        let keep = self.out.map(|_| self.arguments.every);
        if checkpoint.is_none() && from.is_none() {
            let made = run_watched(system, self.method, request, (&[], *event_samples), keep, progress);
            return Ok((made.record, made.trajectory, Ok(())));
        }
        let TextScene { name, words, start, run, .. } = self.scene;
        let identity = resume::identity((name, &(words, start, run)), self.method, &request.schedule);
        let read = from.as_ref().map(|path| resume::read(path, &identity)).transpose()?;
        if let Some(path) = checkpoint {
            resume::check(path, from.as_deref(), scene.force)?;
        }
        let mut warning = Ok(());
        let mut save = |made: &Checkpoint| {
            if let (Some(path), Ok(())) = (checkpoint, &warning) {
                warning = resume::write(path, made);
            }
        };
        let every = checkpoint.as_ref().map(|_| *checkpoint_every);
        let mut saving = Saving { identity: &identity, from: read.as_ref(), every, save: &mut save };
        let outcome = run_saved(system, self.method, request, &mut saving, keep, progress);
        let (record, trajectory) =
            outcome.map_err(|source| CliError::Checkpoint { path: from.clone().unwrap_or_default(), source })?;
        Ok((record, trajectory, warning))
    }
}
