use super::account::{MadeTrain, TrainAccount};
use super::columns::{columns, row};
use crate::args::RunArguments;
use crate::compare::unless_interrupted;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::output::{Output, OutputRequest};
use crate::progress::Interruptible;
use crate::run_rows::{Read, identity, of, position, provenance, tell, with_position};
use crate::trigger::Events;
use crate::{notes, progress, resume, substeps, table, terminal};
use assembly::AssemblyState;
use assembly::parts::Train;
use dla::Checkpoint;
use harness::{AssemblyNode, AssemblyNodes, Method, Progress, Saving, run_assembly_saved};
use scene::Scene;
use std::cell::RefCell;
use std::path::Path;

/// `noslip run` of a train.
pub(crate) fn run(
    arguments: &RunArguments,
    (scene, train): (&Scene, (Train, AssemblyState)),
    method: &Method,
    backward: bool,
    out: Option<OutputRequest<'_>>,
) -> Result<(), CliError> {
    let RunArguments { resume, tolerance, event, until, event_samples, .. } = arguments;
    let checkpoint = arguments.saves().map(|(path, _)| path);
    let account = TrainAccount::new(scene, train, method, (*tolerance, backward), (event, until))?;
    if let (Some(trigger), true) = (event.iter().chain(until).next(), checkpoint.is_some() || resume.is_some()) {
        let problem = format!("--checkpoint and --resume of a train keep no events: leave out {}", trigger.text);
        return Err(CliError::Request(problem));
    }
    let identity = identity(scene, method, &account.schedule);
    let read = resume.as_ref().map(|path| resume::read(path, &identity)).transpose()?;
    if let Some(path) = checkpoint {
        resume::check(path, resume.as_deref(), arguments.scene.force)?;
    }
    let interrupt = Interrupt::listen();
    let made_by = || provenance(arguments, of(scene), &account.schedule);
    let from = || position(read.as_ref());
    let open = |asked| Output::open(asked, made_by(), (columns(&account.train), arguments.every), from());
    let output = RefCell::new(out.map(open).transpose()?);
    let bar = progress::bar(method.info().name, account.schedule.steps);
    let mut shown = Interruptible { bar, interrupt: &interrupt };
    let mut progress = Read { progress: &mut shown, output: &output };
    let mut sink = |k: u64, node: &AssemblyNode| {
        if let Some(output) = output.borrow_mut().as_mut() {
            output.row(k, &row(&account.train, node));
        }
    };
    let nodes = AssemblyNodes::Shown(if out.is_some() { arguments.every } else { u64::MAX }, &mut sink);
    let made = if checkpoint.is_some() || resume.is_some() {
        saved(&account, arguments, (&identity, read.as_ref()), &output, nodes, &mut progress)
    } else {
        Ok((account.watched(*event_samples, nodes, &mut progress), Ok(())))
    };
    shown.bar.finish_and_clear();
    let (mut made, warning) = made?;

    let closed = output.borrow().as_ref().is_some_and(Output::is_closed);
    let interrupted = made.run.record.interrupted;
    let written = output.into_inner().map_or(Ok(()), |output| output.finish(checkpoint.is_some(), interrupted));
    // A reader who has seen enough is no interruption.
    made.run.record.interrupted &= !closed;
    if arguments.scene.json {
        terminal::print_json(&account.object(&made))?;
    } else {
        let file = out.and_then(|asked| asked.path).filter(|_| written.is_ok());
        tell(out, &told(&account, &made, file))?;
    }
    made.events.iter().for_each(Events::warn);
    notes::warn_of_jumps(&made.run.record);
    let computed = CliError::of_failures(account.failure(&made.run));
    if let (Err(_), Err(error)) = (&computed, &written) {
        terminal::say("error", error);
    }
    let record = &made.run.record;
    let made = record.interrupted.then(|| format!("the run reached t = {} s", table::number(record.t)));
    unless_interrupted(made, checkpoint.map(Path::to_owned), computed.and(written).and(warning))
}

/// In parts that are saved, or from a part that was, with the output as far as it had come; and what else went wrong.
fn saved(
    account: &TrainAccount<'_>,
    arguments: &RunArguments,
    (identity, read): (&Checkpoint, Option<&Checkpoint>),
    output: &RefCell<Option<Output<'_>>>,
    nodes: AssemblyNodes<'_>,
    progress: &mut dyn Progress,
) -> Result<(MadeTrain, Result<(), CliError>), CliError> {
    let (to, every) = arguments.saves().unzip();
    let mut saver = resume::Saver::new(to);
    let mut save = |made: &Checkpoint| saver.save(&with_position(made, output));
    let mut saving = Saving { identity, from: read, every, save: &mut save };
    let TrainAccount { train, start, method, schedule, .. } = account;
    let run = run_assembly_saved(&train.assembly, method, schedule, (start, nodes), &mut saving, progress);
    let run =
        run.map_err(|source| CliError::Checkpoint { path: arguments.resume.clone().unwrap_or_default(), source })?;
    Ok((MadeTrain { run, events: None }, saver.outcome()))
}

/// What the run came to, for a person.
fn told(account: &TrainAccount<'_>, made: &MadeTrain, file: Option<&Path>) -> String {
    let (record, [first, last]) = (&made.run.record, account.ends(&made.run));
    let [x, y, heading] = [last.x, last.y, last.heading].map(table::number);
    let more = [
        ("hinges", format!("{:.2e} m at most", record.leaf_max.unwrap_or(0.0))),
        ("trailers", account.train.trailers().len().to_string()),
        ("last blade", format!("x = {x} m, y = {y} m, heading {heading} rad")),
    ];
    let events = made.events.as_ref().map_or("", |events| &events.told);
    let name = (account.scene.title.as_str(), account.scene.name.as_str());
    let text = table::one_run_of(name, record, &table::end_of_sleigh(&first), file) + &substeps::told(record);
    table::realigned(&(text + &table::aligned(&more) + events))
}
