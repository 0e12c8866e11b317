use crate::account::{Account, Made};
use crate::args::{RunArguments, SceneArguments};
use crate::command_line::CommandLine;
use crate::error::{CliError, unless_interrupted};
use crate::file_roles::FileRoles;
use crate::files::place;
use crate::interrupt::Interrupt;
use crate::output::{Output, OutputRequest};
use crate::provenance::Provenance;
use crate::trigger::Events;
use crate::{inspect, progress, resume, substeps, table, terminal, train};
use dla::{Checkpoint, Node, Nodes, Schedule, Substeps};
use harness::{METHODS, MethodKind, Progress, Run, Saving};
use scene::{AnyScene, Built};
use serde_json::json;
use std::cell::RefCell;
use std::path::Path;

/// `noslip run`: one trajectory, as far as Ctrl-C lets it come.
pub(crate) fn run(arguments: &RunArguments) -> Result<(), CliError> {
    let SceneArguments { scene: name, set, step, duration, alpha, json, force } = &arguments.scene;
    // How far, whichever way.
    let settings = arguments.scene.run(arguments.method.as_deref(), duration.map(f64::abs));
    let mut scene = inspect::load_over((name, set), settings)?;
    let mut method = inspect::method(scene.run())?.aiming_for(arguments.tolerance)?;
    if method.is_adaptive() {
        let run = scene.run_mut();
        run.tolerance = arguments.tolerance.or(run.tolerance);
    } else if arguments.tolerance.is_some() && step.is_some() {
        let problem =
            format!("--step and --tolerance both choose the step of {}: give one of them", method.info().name);
        return Err(CliError::Request(problem));
    }
    if arguments.substep {
        method = method.with_substeps(Substeps::default());
    }
    let out = asked(arguments)?;
    if alpha.is_some() && method.info().kind != MethodKind::DlaAlpha {
        let name = method.info().name;
        terminal::say("warning", &format!("--alpha is the weight of dla-alpha; {name} ignores --alpha"));
    }
    inspect::moves(&scene);
    let built = scene.built()?;
    let system = built.system();
    let (checkpoint, resumed) = (arguments.saves().map(|(path, _)| path), arguments.resume.as_deref());
    let backward = duration.is_some_and(|duration| duration < 0.0);
    let (start, watched) = ((&built.q[..], &built.v[..]), (&arguments.event[..], &arguments.until[..]));
    let account = Account::new(&system, (&scene, &method), start, (arguments.tolerance, backward), watched, &mut ())?;
    let schedule = &account.request.schedule;
    let mut identity = resume::identity(&scene, &method, schedule);
    if let Some(events) = account.events_identity(arguments.event_samples) {
        identity = identity.of_run_with("events", &events);
    }
    let read = resumed.map(|path| resume::read(path, &identity)).transpose()?;
    if let Some(path) = checkpoint {
        resume::check(path, resumed, *force)?;
    }
    let interrupt = Interrupt::listen();
    let output = out.map(|asked| {
        let columns = (system.columns(&account.start()), arguments.every);
        Output::open(asked, provenance(arguments, &scene, schedule), columns, read.as_ref().and_then(position))
    });
    let output = RefCell::new(output.transpose()?);
    let derived = system.derivation_seconds();
    let made = progress::shown(method.info().name, schedule.steps, &interrupt, |progress| {
        let mut progress = Read { progress, output: &output };
        let mut sink = |node: &Node| write(&system, node, &output);
        let mut nodes = out.map(|_| Nodes::every(arguments.every, &mut sink));
        if checkpoint.is_some() || resumed.is_some() {
            saved(arguments, &account, (&identity, read.as_ref()), (&output, nodes), &mut progress)
        } else {
            Ok((account.observed(arguments.event_samples, &mut nodes, &mut progress), Ok(())))
        }
    });
    let (mut made, warning) = made?;
    // Formulas that a command derived before the run do not count.
    let derived = system.derivation_seconds() - derived;
    made.record.derivation_seconds = derived;
    made.record.wall_seconds = f64::max(made.record.wall_seconds - derived, 0.0);

    let closed = output.borrow().as_ref().is_some_and(Output::is_closed);
    let interrupted = made.record.interrupted;
    let written = output.into_inner().map_or(Ok(()), |output| output.finish(checkpoint.is_some(), interrupted));
    // A reader who has seen enough is no interruption.
    made.record.interrupted &= !closed;
    let Made { record, events } = &made;
    // The results are shown even if their file could not be written.
    if *json {
        terminal::print_json(&account.object(&made))?;
    } else {
        let file = out.and_then(|asked| asked.path).filter(|_| written.is_ok());
        let mut lines = table::one_run(&scene, record, account.end(record), file);
        lines.extend(substeps::told(record));
        lines.extend(system.train().into_iter().flat_map(|train| train::told(train, record)));
        lines.extend(events.iter().flat_map(|events| events.told.clone()));
        let text = table::aligned(&lines);
        // Standard output may have the rows.
        match out {
            Some(asked) if asked.path.is_none() => terminal::tell(&text),
            _ => terminal::print(&text)?,
        }
    }
    events.iter().for_each(Events::warn);
    inspect::warn(record);
    let computed = CliError::of_failures(substeps::failure(record).or_else(|| table::not_finite(record)));
    if let (Err(_), Err(error)) = (&computed, &written) {
        terminal::say("error", error);
    }
    let made = record.interrupted.then(|| format!("the run reached t = {} s", table::number(record.t)));
    unless_interrupted(made, checkpoint.map(Path::to_owned), computed.and(written).and(warning))
}

/// Where the rows are to be written, if anywhere.
fn asked(arguments: &RunArguments) -> Result<Option<OutputRequest<'_>>, CliError> {
    let RunArguments { out, format, resume, scene, report, .. } = arguments;
    let (saved, roles) = (arguments.saves().map(|(path, _)| path), FileRoles::of(&scene.scene));
    let roles = roles.rows("--out", out.as_deref()).writes("--checkpoint", saved).writes("--report", report.as_deref());
    // A checkpoint that is resumed may be overwritten by a later one.
    let read = resume.as_deref().filter(|path| saved.is_none_or(|saved| place(saved) != place(path)));
    read.into_iter().fold(roles, FileRoles::reads).check()?;
    let Some(path) = out.as_deref() else { return Ok(None) };
    let asked = OutputRequest::new(path, *format, scene.force, resume.is_some())?;
    if asked.path.is_none() && scene.json {
        return Err(CliError::Request("--json and --out - both write to standard output: choose one".to_owned()));
    }
    Ok(Some(asked))
}

/// The provenance of the rows, with the command that makes them again: with the step and the duration that were taken.
fn provenance(arguments: &RunArguments, scene: &AnyScene, schedule: &Schedule) -> Provenance {
    let RunArguments { scene: shared, every, substep, event, until, event_samples, tolerance, out, .. } = arguments;
    let run = scene.run();
    let mut command = CommandLine::of("run", &shared.scene, &shared.set).run(run, schedule.step);
    // For other methods the tolerance has chosen the step.
    let adaptive = METHODS.iter().any(|info| info.name == run.method && info.kind.is_adaptive());
    command = command.maybe("--tolerance", tolerance.filter(|_| adaptive));
    command = event.iter().fold(command, |command, trigger| command.with("--event", &trigger.text));
    command = until.iter().fold(command, |command, trigger| command.with("--until", &trigger.text));
    if !event.is_empty() || !until.is_empty() {
        command = command.with("--event-samples", event_samples);
    }
    command = command.with("--every", every).maybe("--out", out.as_ref().map(|out| out.display()));
    command = command.flag("--substep", *substep);
    let duration = run.duration.copysign(schedule.step);
    let notes = json!({ "method": run.method, "step": schedule.step.abs(), "duration": duration, "every": every });
    Provenance::on(scene, Some(&command), notes)
}

/// How far the output of a checkpoint had come, and whether its run had made a step.
fn position(checkpoint: &Checkpoint) -> Option<([u64; 3], bool)> {
    Some((checkpoint.counts("out").ok()?, checkpoint.counts("k").is_ok_and(|[made]| made > 0)))
}

/// Hands a node to the output.
fn write(system: &Built<'_>, node: &Node, output: &RefCell<Option<Output<'_>>>) {
    if let Some(output) = output.borrow_mut().as_mut() {
        output.row(node.k, &system.row(node));
    }
}

/// Makes the run in parts that are saved, or from a part that was `read`, with the output as far as it had come. Returns also the failure of a
/// save.
fn saved(
    arguments: &RunArguments,
    account: &Account<'_>,
    (identity, read): (&Checkpoint, Option<&Checkpoint>),
    (output, nodes): (&RefCell<Option<Output<'_>>>, Option<Nodes<'_>>),
    progress: &mut dyn Progress,
) -> Result<(Made, Result<(), CliError>), CliError> {
    let Account { system, method, request, .. } = account;
    let (to, every) = arguments.saves().unzip();
    let mut saver = resume::Saver::new(to);
    let mut save = |made: &Checkpoint| {
        let mut made = made.clone();
        if let Some(position) = output.borrow_mut().as_mut().and_then(Output::position) {
            made.put_counts("out", &position);
        }
        saver.save(&made);
    };
    let mut saving = Saving { identity, from: read, every, save: &mut save };
    let events = account.events();
    let mechanism = system.mechanism();
    let run = Run::of(&*mechanism, method).events(&events, arguments.event_samples).progress(progress);
    let outcome = run.saved(request, &mut saving, nodes);
    let path = || arguments.resume.clone().unwrap_or_default();
    let made = outcome.map_err(|source| CliError::Checkpoint { path: path(), source })?;
    Ok((Made { record: made.record, events: account.happened(&made.crossings, made.close) }, saver.outcome()))
}

/// A run that ends when its rows are no longer read.
struct Read<'a, 'b> {
    progress: &'a mut dyn Progress,
    output: &'a RefCell<Option<Output<'b>>>,
}

impl Progress for Read<'_, '_> {
    fn advance(&mut self, steps: u64) {
        self.progress.advance(steps);
    }

    fn stops(&self) -> bool {
        self.progress.stops() || self.output.try_borrow().is_ok_and(|out| out.as_ref().is_some_and(Output::is_closed))
    }
}
