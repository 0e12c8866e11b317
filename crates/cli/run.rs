use crate::account::{Account, Made};
use crate::args::{RunArguments, SceneArguments};
use crate::compare::unless_interrupted;
use crate::error::CliError;
use crate::file_roles::FileRoles;
use crate::files::place;
use crate::interrupt::Interrupt;
use crate::output::{Output, OutputRequest};
use crate::progress::Interruptible;
use crate::run_rows::{Read, identity, position, provenance, tell, with_position};
use crate::trigger::Events;
use crate::{inspect, notes, progress, resume, substeps, table, terminal, train};
use dla::{Checkpoint, Node, Nodes, Schedule, Substeps};
use harness::{Method, MethodKind, Progress, Saving};
use scene::{AnyScene, Built};
use std::cell::RefCell;
use std::path::Path;

/// `noslip run`: one trajectory, as far as Ctrl-C lets it come.
pub(crate) fn run(arguments: &RunArguments) -> Result<(), CliError> {
    let SceneArguments { scene: name, set, step, duration, alpha, .. } = &arguments.scene;
    // How far, whichever way.
    let length = duration.map(f64::abs);
    let mut scene = inspect::load_any_with((name, set), arguments.method.as_deref(), *step, length, *alpha)?;
    let method = inspect::method(scene.run())?.aiming_for(arguments.tolerance)?;
    if method.is_adaptive() {
        let run = scene.run_mut();
        run.tolerance = arguments.tolerance.or(run.tolerance);
    }
    let method = if arguments.substep { method.with_substeps(Substeps::default()) } else { method };
    if arguments.tolerance.is_some() && arguments.scene.step.is_some() && !method.is_adaptive() {
        let name = method.info().name;
        let problem = format!("--step and --tolerance both choose the step of {name}: give one of them");
        return Err(CliError::Request(problem));
    }
    let out = asked(arguments)?;
    if arguments.scene.alpha.is_some() && method.info().kind != MethodKind::DlaAlpha {
        let name = method.info().name;
        terminal::say("warning", &format!("--alpha is the weight of dla-alpha; {name} ignores --alpha"));
    }
    notes::moves(&scene);
    let built = scene.built()?;
    Run { arguments, scene: &scene, method: &method, out }.on(&built.system(), (&built.q, &built.v))
}

/// Whether a run goes backward in time.
fn is_backward(arguments: &RunArguments) -> bool {
    arguments.scene.duration.is_some_and(|duration| duration < 0.0)
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

/// Identifies the run of a scene.
fn identity_of(scene: &AnyScene, method: &Method, schedule: &Schedule) -> Checkpoint {
    match scene {
        AnyScene::Sleigh(scene) => identity(scene, method, schedule),
        // As of a sleigh whose forces jump.
        AnyScene::Text(text) if !text.jumps().is_empty() => {
            let contents = (&text.words, &text.start, &text.run);
            resume::identity_of_whole((&text.name, &contents), method, schedule)
        }
        AnyScene::Text(scene) => {
            let contents = (&scene.words, &scene.start, resume::endless(&scene.run));
            resume::identity((&scene.name, &contents), method, schedule)
        }
    }
}

struct Run<'a> {
    arguments: &'a RunArguments,
    scene: &'a AnyScene,
    method: &'a Method,
    out: Option<OutputRequest<'a>>,
}

impl<'a> Run<'a> {
    /// In parts that are saved, or from a part that was, with the output as far as it had come; and what else went wrong.
    fn saved(
        &self,
        account: &Account<'_>,
        (identity, read): (&Checkpoint, Option<&Checkpoint>),
        output: &RefCell<Option<Output<'a>>>,
        progress: &mut dyn Progress,
    ) -> Result<(Made, Result<(), CliError>), CliError> {
        let RunArguments { resume: from, event_samples, .. } = self.arguments;
        let Account { system, method, request, .. } = account;
        let (to, every) = self.arguments.saves().unzip();
        let mut saver = resume::Saver::new(to);
        let mut save = |made: &Checkpoint| saver.save(&with_position(made, output));
        let mut saving = Saving { identity, from: read, every, save: &mut save };
        let mut sink = |node: &Node| write(system, node, output);
        let nodes = self.out.map(|_| Nodes::every(self.arguments.every, &mut sink));
        let events = account.events();
        let mechanism = system.mechanism();
        let run = harness::Run::of(&*mechanism, method).events(&events, *event_samples).progress(progress);
        let outcome = run.saved(request, &mut saving, nodes);
        let made = outcome.map_err(|source| CliError::Checkpoint { path: from.clone().unwrap_or_default(), source })?;
        Ok((Made { record: made.record, events: account.happened(&made.crossings, made.close) }, saver.outcome()))
    }

    /// The output, begun, or as far as it had come.
    fn output(&self, account: &Account<'_>, read: Option<&Checkpoint>) -> Result<Option<Output<'a>>, CliError> {
        let Some(asked) = self.out else { return Ok(None) };
        let start = account.start();
        let scene = (self.scene.title(), self.scene.run(), self.scene.to_toml().ok());
        let provenance = provenance(self.arguments, scene, &account.request.schedule);
        let columns = (account.system.columns(&start), self.arguments.every);
        Output::open(asked, provenance, columns, position(read)).map(Some)
    }
}

/// Hands a node to the output.
fn write(system: &Built<'_>, node: &Node, output: &RefCell<Option<Output<'_>>>) {
    if let Some(output) = output.borrow_mut().as_mut() {
        output.row(node.k, &system.row(node));
    }
}

impl Run<'_> {
    fn on(self, system: &Built<'_>, (q, v): (&[f64], &[f64])) -> Result<(), CliError> {
        let RunArguments { resume, tolerance, event, until, event_samples, .. } = self.arguments;
        let checkpoint = self.arguments.saves().map(|(path, _)| path);
        let run = (self.scene, self.method);
        let steps = (*tolerance, is_backward(self.arguments));
        let account = Account::new(system, run, (q, v), steps, (event, until), &mut ())?;
        let schedule = &account.request.schedule;
        let mut identity = identity_of(self.scene, self.method, schedule);
        if let Some(events) = account.events_identity(*event_samples) {
            identity = identity.of_run_with("events", &events);
        }
        let read = resume.as_ref().map(|path| resume::read(path, &identity)).transpose()?;
        if let Some(path) = checkpoint {
            resume::check(path, resume.as_deref(), self.arguments.scene.force)?;
        }
        let interrupt = Interrupt::listen();
        let output = RefCell::new(self.output(&account, read.as_ref())?);
        let derived = account.system.derivation_seconds();
        let bar = progress::bar(self.method.info().name, schedule.steps);
        let mut shown = Interruptible { bar, interrupt: &interrupt };
        let mut progress = Read { progress: &mut shown, output: &output };
        let made = if checkpoint.is_some() || resume.is_some() {
            self.saved(&account, (&identity, read.as_ref()), &output, &mut progress)
        } else {
            let mut sink = |node: &Node| write(system, node, &output);
            let mut nodes = self.out.map(|_| Nodes::every(self.arguments.every, &mut sink));
            Ok((account.observed(*event_samples, &mut nodes, &mut progress), Ok(())))
        };
        shown.bar.finish_and_clear();
        let (mut made, warning) = made?;
        // Formulas that a command derived before the run do not count.
        let derived = account.system.derivation_seconds() - derived;
        made.record.derivation_seconds = derived;
        made.record.wall_seconds = f64::max(made.record.wall_seconds - derived, 0.0);

        let closed = output.borrow().as_ref().is_some_and(Output::is_closed);
        let interrupted = made.record.interrupted;
        let written = output.into_inner().map_or(Ok(()), |output| output.finish(checkpoint.is_some(), interrupted));
        // A reader who has seen enough is no interruption.
        made.record.interrupted &= !closed;
        let Made { record, events } = &made;
        // The results are shown even if their file could not be written.
        if self.arguments.scene.json {
            terminal::print_json(&account.object(&made))?;
        } else {
            let file = self.out.and_then(|asked| asked.path).filter(|_| written.is_ok());
            let told = events.as_ref().map_or("", |events| &events.told);
            let name = (self.scene.title(), self.scene.name());
            let text = table::one_run_of(name, record, &account.end(record), file)
                + &table::derivation(record)
                + &substeps::told(record)
                + &system.train().map_or_else(String::new, |train| train::told(train, record))
                + told;
            tell(self.out, &table::realigned(&text))?;
        }
        events.iter().for_each(Events::warn);
        notes::warn_of_jumps(record);
        let computed = CliError::of_failures(substeps::failure(record).or_else(|| table::not_finite(record)));
        if let (Err(_), Err(error)) = (&computed, &written) {
            terminal::say("error", error);
        }
        let made = record.interrupted.then(|| format!("the run reached t = {} s", table::number(record.t)));
        unless_interrupted(made, checkpoint.map(Path::to_owned), computed.and(written).and(warning))
    }
}
