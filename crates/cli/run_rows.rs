//! The provenance of the rows of a run, the identity of the run, and its output.

use crate::args::RunArguments;
use crate::command_line::CommandLine;
use crate::error::CliError;
use crate::output::{Output, OutputRequest, Position};
use crate::provenance::Provenance;
use crate::{resume, terminal};
use dla::{Checkpoint, Schedule};
use harness::{METHODS, Method, Progress};
use scene::{RunSettings, Scene};
use serde_json::json;
use std::cell::RefCell;

/// The provenance of the rows of a run, with the command that makes them again: with the step and the duration that were taken.
pub(crate) fn provenance(
    arguments: &RunArguments,
    (title, run, text): (&str, &RunSettings, Option<String>),
    schedule: &Schedule,
) -> Provenance {
    let RunArguments { scene, every, substep, event, until, event_samples, tolerance, out, .. } = arguments;
    let mut command = CommandLine::of("run", &scene.scene, &scene.set).run(run, schedule.step);
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
    Provenance::on((title, text), Some(&command), notes)
}

/// Identifies the run of a sleigh.
pub(crate) fn identity(scene: &Scene, method: &Method, schedule: &Schedule) -> Checkpoint {
    // The steps of a smooth piece are chosen for its length: a longer run has others after the last jump.
    if scene.jumps().is_ok_and(|jumps| !jumps.is_empty()) {
        return resume::identity_of_whole((&scene.name, scene), method, schedule);
    }
    let contents = Scene { run: resume::endless(&scene.run), ..scene.clone() };
    resume::identity((&scene.name, &contents), method, schedule)
}

/// How far the output of a checkpoint had come, and whether its run had made a step.
pub(crate) fn position(checkpoint: Option<&Checkpoint>) -> Option<(Position, bool)> {
    let checkpoint = checkpoint?;
    let begun = checkpoint.counts("k").is_ok_and(|[made]| made > 0);
    Some((checkpoint.counts("out").ok()?, begun))
}

/// A checkpoint that knows how far the output has come.
pub(crate) fn with_position(made: &Checkpoint, output: &RefCell<Option<Output<'_>>>) -> Checkpoint {
    let mut made = made.clone();
    if let Some(position) = output.borrow_mut().as_mut().and_then(Output::position) {
        made.put_counts("out", &position);
    }
    made
}

/// A run that ends when its rows are no longer read.
pub(crate) struct Read<'a, 'b> {
    pub(crate) progress: &'a mut dyn Progress,
    pub(crate) output: &'a RefCell<Option<Output<'b>>>,
}

impl Progress for Read<'_, '_> {
    fn advance(&mut self, steps: u64) {
        self.progress.advance(steps);
    }

    fn stops(&self) -> bool {
        self.progress.stops() || self.output.try_borrow().is_ok_and(|out| out.as_ref().is_some_and(Output::is_closed))
    }
}

/// Prints the outcome of a run: on standard error if its rows go to standard output, otherwise on standard output.
pub(crate) fn tell(out: Option<OutputRequest<'_>>, text: &str) -> Result<(), CliError> {
    if out.is_some_and(|asked| asked.path.is_none()) {
        terminal::tell(text);
        return Ok(());
    }
    terminal::print(text)
}
