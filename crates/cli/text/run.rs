use super::told;
use crate::args::RunArguments;
use crate::compare::unless_interrupted;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::output::{Asked, Output};
use crate::progress::Interruptible;
use crate::run::{Read, position, provenance, tell, with_position};
use crate::{inspect, json, progress, resume, substeps, table, terminal};
use dla::{Checkpoint, Node, Nodes};
use harness::{Method, Progress, Record, Request, Saving, recommend, run_observed, run_saved};
use scene::{StartedText, TextMechanics, TextScene, with_text};
use std::cell::RefCell;

/// `noslip run` of a system of text.
pub(crate) fn run(
    arguments: &RunArguments,
    scene: &TextScene,
    method: &Method,
    out: Option<Asked<'_>>,
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
    out: Option<Asked<'a>>,
}

/// A run that was made, and what else went wrong.
type Made<const N: usize> = (Record<N>, Result<(), CliError>);

impl<'a> Run<'a> {
    fn make<const N: usize, const M: usize>(&self, started: &StartedText<N, M>) -> Result<(), CliError> {
        let RunArguments { tolerance, scene: flags, checkpoint, resume: from, .. } = self.arguments;
        let (system, q, v) = (&*started.system, started.q, started.v);
        let mut schedule = inspect::steps_of(&self.scene.run);
        if let Some(tolerance) = tolerance {
            // Of the method itself: parts would make any step look good enough.
            let found = recommend(system, &self.method.undivided(), (q, v), self.scene.run.duration, *tolerance);
            let found = found.map_err(|error| CliError::Tolerance(Box::new(error)))?;
            schedule.step = found.step;
            schedule.steps = found.steps;
        }
        let request = Request { schedule, q, v, samples: 1 };
        let TextScene { name, words, start, run, .. } = self.scene;
        let identity = resume::identity((name, &(words, start, resume::endless(run))), self.method, &schedule);
        let read = from.as_ref().map(|path| resume::read(path, &identity)).transpose()?;
        if let Some(path) = checkpoint {
            resume::check(path, from.as_deref(), flags.force)?;
        }
        let interrupt = Interrupt::listen();
        let output = RefCell::new(self.output(system, &request, read.as_ref())?);
        let bar = progress::bar(self.method.info().name, schedule.steps);
        let mut shown = Interruptible { bar, interrupt: &interrupt };
        let mut progress = Read { progress: &mut shown, output: &output };
        let made = self.made(system, &request, (&identity, read.as_ref()), &output, &mut progress);
        shown.bar.finish_and_clear();
        let (mut record, warning) = made?;

        let closed = output.borrow().as_ref().is_some_and(Output::is_closed);
        let interrupted = record.interrupted;
        let written = output.into_inner().map_or(Ok(()), |output| output.finish(checkpoint.is_some(), interrupted));
        // A reader who has seen enough is no interruption.
        record.interrupted &= !closed;
        let model = system.model();
        // What was computed is shown even where its file could not be written.
        if flags.json {
            let end = told::json(model, record.t, &record.q, &record.v);
            let mut object = json::record_of(&self.scene.name, &record, &end);
            substeps::add_json(&mut object, &record);
            terminal::print_json(&object)?;
        } else {
            let file = self.out.and_then(|asked| asked.path).filter(|_| written.is_ok());
            let end = told::lines(model, record.t, &record.q, &record.v);
            let name = (self.scene.title.as_str(), self.scene.name.as_str());
            tell(self.out, &(table::one_run_of(name, &record, &end, file) + &substeps::told(&record)))?;
        }
        let computed = CliError::of_failures(substeps::failure(&record));
        if let (Err(_), Err(error)) = (&computed, &written) {
            terminal::say("error", error);
        }
        let made = record.interrupted.then(|| format!("the run is made up to t = {} s", table::number(record.t)));
        unless_interrupted(made, self.arguments.checkpoint.clone(), computed.and(written).and(warning))
    }

    /// The output, begun, or as far as it had come.
    fn output<const N: usize, const M: usize>(
        &self,
        system: &dyn TextMechanics<N, M>,
        Request { schedule, q, v, .. }: &Request<N>,
        read: Option<&Checkpoint>,
    ) -> Result<Option<Output<'a>>, CliError> {
        let Some(asked) = self.out else { return Ok(None) };
        let scene = (self.scene.title.as_str(), &self.scene.run, source(&self.arguments.scene.scene));
        let columns = (told::columns(system, schedule.t0, (q, v)), self.arguments.every);
        // A run that had made no step begins.
        let read = read.filter(|read| read.counts("k").is_ok_and(|[made]| made > 0));
        Output::open(asked, provenance(self.arguments, scene, schedule), columns, position(read)).map(Some)
    }

    /// At once, or in parts that are saved, or from a part that was.
    fn made<const N: usize, const M: usize>(
        &self,
        system: &dyn TextMechanics<N, M>,
        request: &Request<N>,
        (identity, read): (&Checkpoint, Option<&Checkpoint>),
        output: &RefCell<Option<Output<'a>>>,
        progress: &mut dyn Progress,
    ) -> Result<Made<N>, CliError> {
        let RunArguments { checkpoint, checkpoint_every, resume: from, event_samples, .. } = self.arguments;
        let mut sink = |node: &Node<N, M>| {
            if let Some(output) = output.borrow_mut().as_mut() {
                output.row(node.k, &told::row(system, node));
            }
        };
        let mut nodes = self.out.map(|_| Nodes::every(self.arguments.every, &mut sink));
        if checkpoint.is_none() && from.is_none() {
            let made = run_observed(system, self.method, request, (&[], *event_samples), &mut nodes, progress);
            return Ok((made.record, Ok(())));
        }
        let mut saver = resume::Saver::new(checkpoint.as_deref());
        let mut save = |made: &Checkpoint| saver.save(&with_position(made, output));
        let every = checkpoint.as_ref().map(|_| *checkpoint_every);
        let mut saving = Saving { identity, from: read, every, save: &mut save };
        let outcome = run_saved(system, self.method, request, &mut saving, nodes, progress);
        let record =
            outcome.map_err(|source| CliError::Checkpoint { path: from.clone().unwrap_or_default(), source })?;
        Ok((record, saver.outcome()))
    }
}

/// The text of a scene; none of one that came from standard input.
fn source(name: &str) -> Option<String> {
    let bundled = scene::bundled().iter().find(|scene| scene.name == name.replace('_', "-"));
    bundled.map(|scene| scene.text.to_owned()).or_else(|| std::fs::read_to_string(name).ok())
}
