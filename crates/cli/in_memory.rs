use crate::account::Account;
use crate::called::{Caller, ShownToCaller};
use crate::error::CliError;
use crate::trigger::Trigger;
use crate::{inspect, substeps};
use dla::{AnyState, Node, Samples, Substeps, Trajectory, View};
use harness::{EVENT_SAMPLES, Method};
use scene::{AnyScene, Column};
use serde_json::Value;

/// A run to be made, whose nodes stay in memory: the flags of `noslip run`.
#[derive(Debug, Clone, PartialEq)]
pub struct RunRequest {
    /// Every how many nodes are kept.
    pub every: u64,
    /// Times (s) at which the motion is sampled, in order; with any, they are kept in place of the nodes.
    pub times: Vec<f64>,
    /// Error bound of a step (m or rad): the run takes the longest step below it.
    pub tolerance: Option<f64>,
    /// Whether steps that are refused are divided.
    pub substep: bool,
    /// The events to report, as `speed=0`.
    pub events: Vec<String>,
    /// The events that end the run.
    pub until: Vec<String>,
    /// Whether it goes backward in time.
    pub backward: bool,
}

impl Default for RunRequest {
    fn default() -> Self {
        let (events, until) = (Vec::new(), Vec::new());
        Self { every: 1, times: Vec::new(), tolerance: None, substep: false, events, until, backward: false }
    }
}

/// A run that was made, or the part of it before it failed or was ended.
#[derive(Debug, Clone, PartialEq)]
pub struct RunResult {
    /// The columns, as in the files of `noslip run --out`.
    pub columns: Vec<Column>,
    /// The numbers, column after column.
    pub numbers: Vec<Vec<f64>>,
    /// The object of `noslip run --json`.
    pub object: Value,
    /// Why the run failed, with step and time; `None` if it did not fail.
    pub failure: Option<String>,
    /// Whether the caller ended the run.
    pub interrupted: bool,
}

/// Why no run was made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The message.
    pub message: String,
    /// True if the request is wrong; false if the computation failed.
    pub request: bool,
    /// True if the request needs more memory than is available.
    pub memory: bool,
}

impl From<CliError> for Refusal {
    fn from(error: CliError) -> Self {
        let memory = matches!(error, CliError::Memory(_));
        Self { message: error.to_string(), request: error.exit_code() == 2, memory }
    }
}

/// Refuses sample times (s) that decrease or lie outside the run of `duration` (s).
///
/// # Errors
/// [`Refusal`].
pub fn check_times(times: &[f64], duration: f64) -> Result<(), Refusal> {
    if times.is_sorted() && times.iter().all(|t| (0.0..=duration).contains(t)) {
        return Ok(());
    }
    let message = format!("the times must increase, and lie within the run, from 0 to {duration:?} s");
    Err(CliError::Request(message).into())
}

/// Makes the run of a scene, with its method, step and duration.
///
/// # Errors
/// [`Refusal`] if the request does not fit the scene, or no step meets the tolerance. A run that fails is a result.
pub fn run(scene: &AnyScene, request: &RunRequest, caller: &Caller) -> Result<RunResult, Refusal> {
    check_times(&request.times, scene.run().duration)?;
    let method = inspect::method(scene.run())?.aiming_for(request.tolerance).map_err(CliError::from)?;
    let method = if request.substep { method.with_substeps(Substeps::default()) } else { method };
    Ok(made(scene, request, &method, caller)?)
}

/// Maximum count of numbers that runs keep in memory.
pub(crate) const MOST_NUMBERS: u64 = 100_000_000;

impl RunRequest {
    /// Refuses, before the run, more than [`MOST_NUMBERS`] numbers for `steps` steps of `columns` columns.
    pub(crate) fn fits(&self, steps: u64, columns: usize) -> Result<(), CliError> {
        let kept = if self.times.is_empty() { steps / self.every.max(1) + 2 } else { self.times.len() as u64 };
        let columns = (columns as u64).max(1);
        if kept.saturating_mul(columns) <= MOST_NUMBERS {
            return Ok(());
        }
        let least = steps.div_ceil((MOST_NUMBERS / columns).saturating_sub(2).max(1));
        Err(CliError::Memory(format!(
            "the run keeps {kept} nodes of {columns} numbers in memory, and {MOST_NUMBERS} numbers are the most: every={least} keeps fewer \
             nodes, t_eval= the motion at some times, and `noslip run --out FILE` writes them all"
        )))
    }
}

/// Parses the events that are looked for.
fn triggers(texts: &[String]) -> Result<Vec<Trigger>, CliError> {
    texts.iter().map(|text| text.parse().map_err(CliError::Request)).collect()
}

fn made(scene: &AnyScene, request: &RunRequest, method: &Method, caller: &Caller) -> Result<RunResult, CliError> {
    let RunRequest { every, times, tolerance, events, until, backward, .. } = request;
    let built = scene.built()?;
    let (system, start) = (&built.system(), (&built.q[..], &built.v[..]));
    let (reported, ending) = (triggers(events)?, triggers(until)?);
    let mut search = ShownToCaller::new(caller, "choosing a step", 0);
    let (run, steps) = ((scene, method), (*tolerance, *backward));
    let account = Account::new(system, run, start, steps, (&reported, &ending), &mut search)?;
    let schedule = account.request.schedule;
    request.fits(schedule.steps, system.columns(&account.start()).len())?;
    let mut shown = ShownToCaller::new(caller, method.info().name, schedule.steps);
    let (mut trajectory, sampled): (_, Vec<Node>);
    let mechanism = system.mechanism();
    let (made, nodes) = if times.is_empty() {
        trajectory = Trajectory::every(*every);
        let made = account.observed(EVENT_SAMPLES, &mut trajectory, &mut shown);
        (made, trajectory.nodes())
    } else {
        let mut samples = Samples::new(method, times);
        let made = account.observed(EVENT_SAMPLES, &mut samples, &mut shown);
        // The motion at the times asked for, as far as the run comes; the work is not known there.
        let node = |(t, state): (&f64, &AnyState)| {
            let piece = mechanism.smooth_piece(*t);
            Node::of(&View { system: &*piece, k: 0, t: *t, state }, f64::NAN, None)
        };
        sampled = times.iter().zip(samples.taken()).map(node).collect();
        (made, &sampled[..])
    };
    let columns = nodes.first().map_or_else(Vec::new, |first| system.columns(first));
    let mut numbers = vec![Vec::new(); columns.len()];
    if numbers.iter_mut().any(|column: &mut Vec<f64>| column.try_reserve_exact(nodes.len()).is_err()) {
        let problem = format!("{} nodes of {} numbers do not fit into memory", nodes.len(), columns.len());
        return Err(CliError::Memory(format!("{problem}: every= keeps fewer nodes, t_eval= the motion at some times")));
    }
    for node in nodes {
        numbers.iter_mut().zip(system.row(node)).for_each(|(column, x)| column.push(x));
    }
    let (object, record) = (account.object(&made), &made.record);
    let (failure, interrupted) = (substeps::failure(record), record.interrupted);
    Ok(RunResult { columns, numbers, object, failure, interrupted })
}
