use crate::args::RunArguments;
use crate::compare::unless_interrupted;
use crate::error::CliError;
use crate::files::check_file;
use crate::interrupt::Interrupt;
use crate::progress::Interruptible;
use crate::trajectory_file::{self, Format};
use crate::trigger::{Events, Happened, Trigger};
use crate::{inspect, json, progress, resume, substeps, table, terminal, text, train_run};
use dla::{Checkpoint, Schedule, Substeps, Trajectory};
use harness::{Kind, Method, Progress, Record, Request, Saving, Watched, recommend, run_saved, run_watched};
use scene::{AnyScene, Scene, SceneSystem, Visitor};
use std::path::Path;

/// `noslip run`: one trajectory, as far as Ctrl-C lets it come.
pub(crate) fn run(arguments: &RunArguments) -> Result<(), CliError> {
    let scene = inspect::load_any(&arguments.scene, arguments.method.as_deref())?;
    let settings = scene.run();
    let method = Method::of(&settings.method, settings.alpha, settings.tolerance)?;
    let method = if arguments.substep { method.with_substeps(Substeps::default()) } else { method };
    let method = match arguments.tolerance {
        Some(tolerance) if method.is_adaptive() => method.with_tolerance(tolerance)?,
        _ => method,
    };
    let out = match &arguments.out {
        Some(path) => {
            let format = Format::of(path)?;
            let steps = if let AnyScene::Sleigh(scene) = &scene { scene.schedule().steps } else { settings.steps() };
            trajectory_file::check_size(steps, arguments.every)?;
            check_file(path, arguments.scene.force)?;
            Some((path.as_path(), format))
        }
        None => None,
    };
    if arguments.scene.alpha.is_some() && method.info().kind != Kind::DlaAlpha {
        let name = method.info().name;
        terminal::say("warning", &format!("--alpha is the weight of dla-alpha; {name} has none and ignores it"));
    }
    let scene = match scene {
        AnyScene::Sleigh(scene) => *scene,
        AnyScene::Text(scene) => return text::run::run(arguments, &scene, &method, out),
    };
    if scene.has_trailers() {
        return train_run::run(arguments, &scene, &method, out);
    }
    scene.visit(Run { arguments, scene: &scene, method, out })?
}

struct Run<'a> {
    arguments: &'a RunArguments,
    scene: &'a Scene,
    method: Method,
    out: Option<(&'a Path, Format)>,
}

/// A run that was made, with the nodes that are to be written.
struct Made<const N: usize, const M: usize> {
    record: Record<N>,
    trajectory: Option<Trajectory<N, M>>,
    /// What happened, where that was asked for.
    events: Option<Events>,
    /// What else went wrong.
    warning: Result<(), CliError>,
}

impl Run<'_> {
    /// Every how many nodes are kept, where any are.
    fn keep(&self) -> Option<u64> {
        self.out.map(|_| self.arguments.every)
    }

    /// In parts that are saved, or from a part that was.
    fn saved<const N: usize, const M: usize>(
        &self,
        system: &dyn SceneSystem<N, M>,
        request: &Request<N>,
        progress: &mut dyn Progress,
    ) -> Result<Made<N, M>, CliError> {
        let RunArguments { checkpoint, checkpoint_every, resume: from, scene, .. } = self.arguments;
        let identity = resume::identity((&self.scene.name, self.scene), &self.method, &request.schedule);
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
        let outcome = run_saved(&system, &self.method, request, &mut saving, self.keep(), progress);
        let (record, trajectory) =
            outcome.map_err(|source| CliError::Checkpoint { path: from.clone().unwrap_or_default(), source })?;
        Ok(Made { record, trajectory, events: None, warning })
    }

    /// At once, with an eye on events where there are any.
    fn watched<const N: usize, const M: usize>(
        &self,
        system: &dyn SceneSystem<N, M>,
        request: &Request<N>,
        progress: &mut dyn Progress,
    ) -> Made<N, M> {
        let RunArguments { event, until, event_samples, .. } = self.arguments;
        let reported = event.iter().map(|trigger| trigger.event(system));
        let events: Vec<_> = reported.chain(until.iter().map(|trigger| trigger.event(system).terminal())).collect();
        let Watched { record, trajectory, crossings, close } =
            run_watched(&system, &self.method, request, (&events, *event_samples), self.keep(), progress);
        let triggers: Vec<&Trigger> = event.iter().chain(until).collect();
        let happened = crossings.iter().filter_map(|crossing| Happened::of(system, &triggers, crossing));
        let events = (!triggers.is_empty()).then(|| Events::new(happened, close));
        Made { record, trajectory, events, warning: Ok(()) }
    }
}

impl Visitor for Run<'_> {
    type Output = Result<(), CliError>;

    fn visit<const N: usize, const M: usize>(
        self,
        system: &dyn SceneSystem<N, M>,
        q: [f64; N],
        v: [f64; N],
    ) -> Self::Output {
        let RunArguments { checkpoint, resume, tolerance, .. } = self.arguments;
        let mut schedule = inspect::schedule(self.scene);
        if let Some(tolerance) = tolerance.filter(|_| !self.method.is_adaptive()) {
            // Of the method itself: parts would make any step look good enough.
            let method = self.method.undivided();
            let found = recommend(&system, &method, (q, v), self.scene.run.duration, tolerance);
            let found = found.map_err(|error| CliError::Tolerance(Box::new(error)))?;
            schedule = Schedule { step: found.step, steps: found.steps, ..schedule };
            if self.out.is_some() {
                trajectory_file::check_size(schedule.steps, self.arguments.every)?;
            }
        }
        let interrupt = Interrupt::listen();
        let bar = progress::bar(self.method.info().name, schedule.steps);
        let mut progress = Interruptible { bar, interrupt: &interrupt };
        let request = Request { schedule, q, v, samples: 1 };
        let made = if checkpoint.is_some() || resume.is_some() {
            self.saved(system, &request, &mut progress)
        } else {
            Ok(self.watched(system, &request, &mut progress))
        };
        progress.bar.finish_and_clear();
        let Made { record, trajectory, events, warning } = made?;

        let written = self.out.zip(trajectory).map_or(Ok(()), |((path, format), trajectory)| {
            trajectory_file::write(system, trajectory.nodes(), path, format, self.arguments.scene.force)
        });
        let end = system.sleigh_state(&record.q, &record.v);
        // What was computed is shown even where its file could not be written.
        if self.arguments.scene.json {
            let mut object = json::record(&self.scene.name, &record, &end);
            substeps::add_json(&mut object, &record);
            if let Some(events) = &events {
                events.add_to(&mut object);
            }
            terminal::print_json(&object)?;
        } else {
            let file = self.out.and_then(|(path, _)| written.is_ok().then_some(path));
            let told = events.as_ref().map_or("", |events| &events.told);
            terminal::print(&(table::one_run(self.scene, &record, &end, file) + &substeps::told(&record) + told))?;
        }
        events.iter().for_each(Events::warn);
        let computed = CliError::of_failures(substeps::failure(&record).or_else(|| table::not_finite(&record)));
        if let (Err(_), Err(error)) = (&computed, &written) {
            terminal::say("error", error);
        }
        let made = record.interrupted.then(|| format!("the run is made up to t = {} s", table::number(record.t)));
        unless_interrupted(made, checkpoint.clone(), computed.and(written).and(warning))
    }
}
