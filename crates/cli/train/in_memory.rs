use super::account::TrainAccount;
use super::columns::{columns, row};
use crate::called::{Caller, ShownToCaller};
use crate::error::CliError;
use crate::in_memory::{RunRequest, RunResult, triggers};
use assembly::AssemblyState;
use assembly::parts::Train;
use harness::{AssemblyNode, AssemblyNodes, EVENT_SAMPLES, Method, sample_assembly};
use scene::Scene;

/// Makes the run of a train, whose nodes, or places at some times, stay in memory.
pub(crate) fn in_memory(
    (scene, train): (&Scene, (Train, AssemblyState)),
    request: &RunRequest,
    method: &Method,
    caller: &Caller,
) -> Result<RunResult, CliError> {
    let RunRequest { every, times, tolerance, events, until, backward, .. } = request;
    let (reported, ending) = (triggers(events)?, triggers(until)?);
    let account = TrainAccount::new(scene, train, method, (*tolerance, *backward), (&reported, &ending))?;
    let columns = columns(&account.train);
    request.fits(account.schedule.steps, columns.len())?;
    let mut numbers = vec![Vec::new(); columns.len()];
    let mut keep = |node: &AssemblyNode| {
        numbers.iter_mut().zip(row(&account.train, node)).for_each(|(column, x)| column.push(x));
    };
    let mut shown = ShownToCaller::new(caller, method.info().name, account.schedule.steps);
    let made = if times.is_empty() {
        account.watched(EVENT_SAMPLES, AssemblyNodes::Shown(*every, &mut |_, node| keep(node)), &mut shown)
    } else {
        account.watched(EVENT_SAMPLES, AssemblyNodes::Shown(u64::MAX, &mut |_, _| ()), &mut shown)
    };
    let mut failure = account.failure(&made.run);
    if !times.is_empty() {
        // A second time: the nodes of the first are at times of its own. Only as far as that came.
        let reached = made.run.record.t;
        let within = |t: &&f64| if *backward { **t >= reached } else { **t <= reached };
        let times: Vec<f64> = times.iter().take_while(within).copied().collect();
        let TrainAccount { train, start, schedule, .. } = &account;
        let sampled = sample_assembly(&train.assembly, method, schedule, start, &times, &mut keep);
        failure = failure.or(sampled.err().map(|error| error.to_string()));
    }
    let (object, interrupted) = (account.object(&made), made.run.record.interrupted);
    Ok(RunResult { columns, numbers, object, failure, interrupted })
}
