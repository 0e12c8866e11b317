//! `noslip run` of a scene with trailers.

use crate::args::RunArguments;
use crate::compare::unless_interrupted;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::output::{Output, OutputRequest};
use crate::progress::Interruptible;
use crate::run_rows::{Read, identity, of, position, provenance, tell, with_position};
use crate::trigger::{Events, Happened, Trigger};
use crate::{inspect, json, progress, resume, substeps, table, terminal};
use assembly::AssemblyState;
use assembly::parts::Train;
use dla::{Checkpoint, Schedule};
use harness::{
    Assembled, AssemblyCrossing, AssemblyNode, AssemblyNodes, Method, Progress, Saving, recommend_assembly,
    run_assembly_saved, run_assembly_watched,
};
use scene::{Column, Scene};
use serde_json::json;
use sleigh::SleighState;
use std::cell::RefCell;

/// `noslip run` of a train.
pub(crate) fn run(
    arguments: &RunArguments,
    scene: &Scene,
    method: &Method,
    out: Option<OutputRequest<'_>>,
) -> Result<(), CliError> {
    let Some((train, start)) = scene.train()? else { return Ok(()) };
    let RunArguments { checkpoint, resume, tolerance, event, until, .. } = arguments;
    event.iter().chain(until).try_for_each(|trigger| trigger.on_blade().map(drop))?;
    if let (Some(trigger), true) = (event.iter().chain(until).next(), checkpoint.is_some() || resume.is_some()) {
        let problem = format!("--checkpoint and --resume of a train keep no events: leave out {}", trigger.text);
        return Err(CliError::Request(problem));
    }
    let mut schedule = inspect::schedule(scene);
    if let Some(tolerance) = tolerance {
        let (assembly, duration) = (&train.assembly, scene.run.duration);
        // Of the method itself: parts would make any step look good enough.
        let whole = method.undivided();
        let found = recommend_assembly(assembly, &whole, &start, duration, *tolerance, |state| ends(&train, state));
        let found = found.map_err(|error| CliError::Tolerance(Box::new(error)))?;
        schedule = Schedule { step: found.step, steps: found.steps, ..schedule };
    }
    let identity = identity(scene, method, &schedule);
    let read = resume.as_ref().map(|path| resume::read(path, &identity)).transpose()?;
    if let Some(path) = checkpoint {
        resume::check(path, resume.as_deref(), arguments.scene.force)?;
    }
    let interrupt = Interrupt::listen();
    let made_by = || provenance(arguments, of(scene), &schedule);
    // A run that had made no step begins.
    let begun = read.as_ref().filter(|read| read.counts("k").is_ok_and(|[made]| made > 0));
    let open = |asked| Output::open(asked, made_by(), (header(&train), arguments.every), position(begun));
    let output = RefCell::new(out.map(open).transpose()?);
    let bar = progress::bar(method.info().name, schedule.steps);
    let mut shown = Interruptible { bar, interrupt: &interrupt };
    let mut progress = Read { progress: &mut shown, output: &output };
    let request = TrainRequest { method, train: &train, start: &start, schedule: &schedule, output: &output };
    let made = if checkpoint.is_some() || resume.is_some() {
        request.saved(arguments, (&identity, read.as_ref()), &mut progress)
    } else {
        request.watched(arguments, &mut progress)
    };
    shown.bar.finish_and_clear();
    let MadeTrain { run: Assembled { mut record, end, failure, .. }, events, warning } = made?;

    let closed = output.borrow().as_ref().is_some_and(Output::is_closed);
    let interrupted = record.interrupted;
    let written = output.into_inner().map_or(Ok(()), |output| output.finish(checkpoint.is_some(), interrupted));
    // A reader who has seen enough is no interruption.
    record.interrupted &= !closed;
    let blades = train.trailers().len();
    let (first, last) = (train.blade(&end, 0), train.blade(&end, blades));
    if arguments.scene.json {
        let mut object = json::record(&scene.name, &record, &first);
        substeps::add_json(&mut object, &record);
        object["constraint"]["leaf_max"] = json!(record.leaf_max);
        object["trailers"] = json!(blades);
        let SleighState { x, y, heading, speed, turn_rate } = last;
        object["last"] = json!({"x": x, "y": y, "heading": heading, "speed": speed, "turn_rate": turn_rate});
        if let Some(events) = &events {
            events.add_to(&mut object);
        }
        terminal::print_json(&object)?;
    } else {
        let file = out.and_then(|asked| asked.path).filter(|_| written.is_ok());
        let joints = format!("{:.2e} m at most", record.leaf_max.unwrap_or(0.0));
        let [x, y, heading] = [last.x, last.y, last.heading].map(table::number);
        let more = [
            ("hinges", joints),
            ("trailers", blades.to_string()),
            ("last blade", format!("x = {x} m, y = {y} m, heading {heading} rad")),
        ];
        let told = events.as_ref().map_or("", |events| &events.told);
        let parts = substeps::told(&record);
        let name = (scene.title.as_str(), scene.name.as_str());
        let text = table::one_run_of(name, &record, &table::end_of_sleigh(&first), file) + &parts;
        tell(out, &table::realigned(&(text + &table::aligned(&more) + told)))?;
    }
    events.iter().for_each(Events::warn);
    // The static record does not know which hinge it was.
    let told = substeps::failure(&record).map(|told| match &failure {
        Some(error) if !told.contains(&error.source.to_string()) => format!("{told}; {error}"),
        _ => told,
    });
    let computed = CliError::of_failures(told);
    if let (Err(_), Err(error)) = (&computed, &written) {
        terminal::say("error", error);
    }
    let made = record.interrupted.then(|| format!("the run reached t = {} s", table::number(record.t)));
    unless_interrupted(made, checkpoint.clone(), computed.and(written).and(warning))
}

/// A run of a train to be made.
struct TrainRequest<'a, 'o> {
    method: &'a Method,
    train: &'a Train,
    start: &'a AssemblyState,
    schedule: &'a Schedule,
    output: &'a RefCell<Option<Output<'o>>>,
}

/// A run that was made.
struct MadeTrain {
    run: Assembled,
    /// What happened, where that was asked for.
    events: Option<Events>,
    /// What else went wrong.
    warning: Result<(), CliError>,
}

impl TrainRequest<'_, '_> {
    /// Hands a node to the output.
    fn write(&self, k: u64, node: &AssemblyNode) {
        if let Some(output) = self.output.borrow_mut().as_mut() {
            output.row(k, &row(self.train, node));
        }
    }

    /// In parts that are saved, or from a part that was, with the output as far as it had come.
    fn saved(
        &self,
        arguments: &RunArguments,
        (identity, read): (&Checkpoint, Option<&Checkpoint>),
        progress: &mut dyn Progress,
    ) -> Result<MadeTrain, CliError> {
        let RunArguments { checkpoint, checkpoint_every, resume: from, .. } = arguments;
        let mut saver = resume::Saver::new(checkpoint.as_deref());
        let mut save = |made: &Checkpoint| saver.save(&with_position(made, self.output));
        let every = checkpoint.as_ref().map(|_| *checkpoint_every);
        let mut saving = Saving { identity, from: read, every, save: &mut save };
        let mut sink = |k: u64, node: &AssemblyNode| self.write(k, node);
        let (assembly, start) = (&self.train.assembly, (self.start, self.nodes(arguments, &mut sink)));
        let run = run_assembly_saved(assembly, self.method, self.schedule, start, &mut saving, progress);
        let run = run.map_err(|source| CliError::Checkpoint { path: from.clone().unwrap_or_default(), source })?;
        Ok(MadeTrain { run, events: None, warning: saver.outcome() })
    }

    /// The nodes that are written, if any are.
    fn nodes<'s>(&self, arguments: &RunArguments, sink: &'s mut dyn FnMut(u64, &AssemblyNode)) -> AssemblyNodes<'s> {
        let every = if arguments.out.is_some() { arguments.every } else { u64::MAX };
        AssemblyNodes::Shown(every, sink)
    }

    /// At once, with an eye on events where there are any.
    fn watched(&self, arguments: &RunArguments, progress: &mut dyn Progress) -> Result<MadeTrain, CliError> {
        let RunArguments { event, until, event_samples, .. } = arguments;
        let on_blade = event.iter().chain(until).map(Trigger::on_blade);
        let watched = on_blade.collect::<Result<Vec<_>, _>>()?;
        let is_last = |k: usize| k >= event.len();
        let events: Vec<_> = watched.iter().enumerate().map(|(k, one)| one.event(self.train, is_last(k))).collect();
        let mut sink = |k: u64, node: &AssemblyNode| self.write(k, node);
        let (assembly, looked_for) = (&self.train.assembly, (&events[..], *event_samples));
        let start = (self.start, self.nodes(arguments, &mut sink));
        let (run, crossings) = run_assembly_watched(assembly, self.method, self.schedule, start, looked_for, progress);
        let happened = crossings.iter().filter_map(|crossing| Happened::of_train(self.train, &watched, crossing));
        let events = (!watched.is_empty()).then(|| Events::new(happened, AssemblyCrossing::close(&crossings)));
        Ok(MadeTrain { run, events, warning: Ok(()) })
    }
}

/// Place and heading of the first and of the last blade, by which a tolerance is met.
fn ends(train: &Train, state: &AssemblyState) -> [f64; 6] {
    let [first, last] = [0, train.trailers().len()].map(|k| train.blade(state, k));
    [first.x, first.y, first.heading, last.x, last.y, last.heading]
}

/// The columns of a train: those of its first blade, and the headings of the others.
fn header(train: &Train) -> Vec<Column> {
    let own = [
        ("t", "s"),
        ("x", "m"),
        ("y", "m"),
        ("heading", "rad"),
        ("speed", "m/s"),
        ("turn_rate", "rad/s"),
        ("energy", "J"),
        ("work", "J"),
        ("constraint", "m/s"),
        ("hinges", "m"),
    ];
    let others = (1..=train.trailers().len()).map(|k| Column::new(format!("heading_{k}"), "rad"));
    own.into_iter().map(|(name, unit)| Column::new(name, unit)).chain(others).collect()
}

/// The numbers of a node in these columns.
fn row(train: &Train, node: &AssemblyNode) -> Vec<f64> {
    let SleighState { x, y, heading, speed, turn_rate } = first(&node.q, &node.v);
    let AssemblyNode { t, energy, work, constraint, joint, .. } = *node;
    let mut row = vec![t, x, y, heading, speed, turn_rate, energy, work, constraint, joint];
    row.extend((1..=train.trailers().len()).map(|k| node.q[3 * k + 2]));
    row
}

/// The state of the first blade.
fn first(q: &[f64], v: &[f64]) -> SleighState {
    let of = |x: &[f64]| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
    SleighState::from_coordinates(&of(q), &of(v))
}
