use super::making::{AssemblyTicker, Making};
use super::{Assembled, AssemblyNodes};
use crate::saved::within;
use crate::{Method, Progress, Saving};
use assembly::{Assembly, AssemblyState};
use dla::{CheckpointError, Schedule};
use std::ops::ControlFlow;

/// Makes a run of an assembly as [`run_assembly`](crate::run_assembly) does, in parts that are saved, or from a part that was.
///
/// The record is the same to the last bit whether the run was made at once or in parts, but for its time. The nodes are those
/// since the last checkpoint. Where the progress ends the run a last checkpoint is made; so is one at its end.
///
/// # Errors
/// [`CheckpointError`] where the checkpoint does not belong to this run; nothing is then done.
pub fn run_assembly_saved(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    (start, nodes): (&AssemblyState, AssemblyNodes<'_>),
    saving: &mut Saving<'_>,
    progress: &mut dyn Progress,
) -> Result<Assembled, CheckpointError> {
    let mut making = match saving.from {
        Some(checkpoint) => {
            checkpoint.belongs_to(saving.identity)?;
            let [made] = checkpoint.counts("k")?;
            within(made, schedule.steps)?;
            Making::load(assembly, method, schedule, nodes, checkpoint)?
        }
        None => Making::new(assembly, method, schedule, start, nodes),
    };
    progress.advance(making.made);
    let mut ticker = AssemblyTicker::new(progress, making.made);
    loop {
        let next =
            saving.every.map_or(schedule.steps, |every| (making.made / every).saturating_add(1).saturating_mul(every));
        making.go(next.min(schedule.steps), &mut ticker, |_, _| ControlFlow::Continue(()));
        if saving.every.is_some() && !making.failed() {
            (saving.save)(&making.checkpoint(saving.identity));
        }
        if making.is_over() || ticker.stopped {
            break;
        }
    }
    ticker.finish(making.made);
    Ok(making.assembled(ticker.stopped))
}
