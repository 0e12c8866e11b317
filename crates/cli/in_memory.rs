use crate::called::Caller;
use crate::trigger::{Events, Happened, Trigger};
use crate::{inspect, json, substeps};
use dla::{Node, Samples, Schedule, State, Substeps, Trajectory};
use harness::{Again, EVENT_SAMPLES, Method, Progress, Request, Watched, integrate_on, recommend, run_watched};
use indicatif::ProgressBar;
use scene::{Column, Scene, SceneSystem, Visitor};
use serde_json::Value;
use std::fmt::Display;

/// A run to be made, whose nodes stay in memory: the flags of `noslip run`.
#[derive(Debug, Clone, PartialEq)]
pub struct RunRequest {
    /// Every how many nodes are kept.
    pub every: u64,
    /// Times (s) at which the motion is sampled, in order; with any, they are kept in place of the nodes.
    pub times: Vec<f64>,
    /// The step is the longest whose error stays below this (m or rad).
    pub tolerance: Option<f64>,
    /// Whether steps that are refused are divided.
    pub substep: bool,
    /// What is reported, as `speed=0`.
    pub events: Vec<String>,
    /// What ends the run.
    pub until: Vec<String>,
}

impl Default for RunRequest {
    fn default() -> Self {
        let (events, until) = (Vec::new(), Vec::new());
        Self { every: 1, times: Vec::new(), tolerance: None, substep: false, events, until }
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
    /// Why the run failed, with step and time, where it did.
    pub failure: Option<String>,
    /// Whether the caller ended the run.
    pub interrupted: bool,
}

/// Why no run was made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunError {
    /// What is wrong.
    pub message: String,
    /// Whether the request is: else the computation failed.
    pub request: bool,
}

impl RunError {
    fn request(error: &impl Display) -> Self {
        Self { message: error.to_string(), request: true }
    }
}

/// Makes the run of a scene, with its method, step and duration.
///
/// # Errors
/// [`RunError`] where the request makes no sense for the scene, or no step meets the tolerance. A run that fails is a result.
pub fn run(scene: &Scene, request: &RunRequest, caller: &Caller) -> Result<RunResult, RunError> {
    let method = Method::named(&scene.run.method, scene.run.alpha).map_err(|error| RunError::request(&error))?;
    let method = if request.substep { method.with_substeps(Substeps::default()) } else { method };
    if scene.has_trailers() {
        return Err(RunError::request(&"trains are run by the command line: their nodes are not kept in memory here"));
    }
    let run = Run { scene, request, method, caller };
    scene.visit(run).map_err(|error| RunError::request(&error))?
}

struct Run<'a> {
    scene: &'a Scene,
    request: &'a RunRequest,
    method: Method,
    caller: &'a Caller,
}

/// Shows a run to the caller, who may end it.
struct Shown<'a> {
    bar: ProgressBar,
    caller: &'a Caller,
}

impl Progress for Shown<'_> {
    fn advance(&mut self, steps: u64) {
        self.bar.inc(steps);
    }

    fn stops(&self) -> bool {
        self.caller.stops()
    }
}

/// The events that are looked for, as they are written.
fn triggers(texts: &[String]) -> Result<Vec<Trigger>, RunError> {
    texts.iter().map(|text| text.parse().map_err(|error: String| RunError::request(&error))).collect()
}

impl Run<'_> {
    fn schedule<const N: usize, const M: usize>(
        &self,
        system: &dyn SceneSystem<N, M>,
        start: ([f64; N], [f64; N]),
    ) -> Result<Schedule, RunError> {
        let schedule = inspect::schedule(self.scene);
        let Some(tolerance) = self.request.tolerance else { return Ok(schedule) };
        let found = recommend(&system, &self.method.undivided(), start, self.scene.run.duration, tolerance);
        let found = found.map_err(|error| RunError { message: error.to_string(), request: false })?;
        Ok(Schedule { step: found.step, steps: found.steps, ..schedule })
    }

    /// The motion at the times asked for, up to where the run comes; the work is not known there.
    fn sampled<const N: usize, const M: usize>(
        &self,
        system: &dyn SceneSystem<N, M>,
        Request { schedule, q, v, .. }: &Request<N>,
        shown: &mut Shown<'_>,
    ) -> Vec<Node<N, M>> {
        let times = &self.request.times;
        let mut samples = Samples::new(Again { method: &self.method, own: &system }, times);
        let mut state = State::new(*q, *v, system.angles());
        // Why a run ends early is what the run that was watched has told.
        let _ = integrate_on(&system, &self.method, schedule, &mut state, &mut samples, shown);
        let node = |(t, state): (&f64, &State<N>)| {
            let (q, v) = (state.unwrapped(), *state.v());
            let piece = system.scene_piece(*t);
            let residual = piece.residual(*t, &q, &v).iter().fold(0.0, |most: f64, each| most.max(each.abs()));
            let energy = piece.energy(*t, &q, &v);
            Node { k: 0, t: *t, q, v, energy, work: f64::NAN, constraint: residual, multipliers: None }
        };
        times.iter().zip(samples.taken()).map(node).collect()
    }
}

impl Visitor for Run<'_> {
    type Output = Result<RunResult, RunError>;

    fn visit<const N: usize, const M: usize>(
        self,
        system: &dyn SceneSystem<N, M>,
        q: [f64; N],
        v: [f64; N],
    ) -> Self::Output {
        let RunRequest { every, times, events, until, .. } = self.request;
        let request = Request { schedule: self.schedule(system, (q, v))?, q, v, samples: 1 };
        let (reported, ending) = (triggers(events)?, triggers(until)?);
        let looked_for: Vec<_> = reported
            .iter()
            .map(|trigger| trigger.event(system))
            .chain(ending.iter().map(|trigger| trigger.event(system).terminal()))
            .collect();
        let mut shown =
            Shown { bar: self.caller.bar(self.method.info().name, request.schedule.steps), caller: self.caller };
        let keep = times.is_empty().then_some(*every);
        let looked_for = (&looked_for[..], EVENT_SAMPLES);
        let Watched { record, trajectory, crossings, close } =
            run_watched(&system, &self.method, &request, looked_for, keep, &mut shown);
        let sampled = if trajectory.is_none() { self.sampled(system, &request, &mut shown) } else { Vec::new() };
        let nodes = trajectory.as_ref().map_or(&sampled[..], Trajectory::nodes);

        let columns = nodes.first().map_or_else(Vec::new, |first| system.columns(first));
        let mut numbers: Vec<_> = columns.iter().map(|_| Vec::with_capacity(nodes.len())).collect();
        for node in nodes {
            numbers.iter_mut().zip(system.row(node)).for_each(|(column, number)| column.push(number));
        }
        let mut object = json::record(&self.scene.name, &record, &system.sleigh_state(&record.q, &record.v));
        substeps::add_json(&mut object, &record);
        let looked: Vec<&Trigger> = reported.iter().chain(&ending).collect();
        if !looked.is_empty() {
            let happened = crossings.iter().filter_map(|crossing| Happened::of(system, &looked, crossing));
            Events::new(happened, close).add_to(&mut object);
        }
        let failure = substeps::failure(&record);
        Ok(RunResult { columns, numbers, object, failure, interrupted: record.interrupted })
    }
}
