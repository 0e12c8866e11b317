use crate::called::Caller;
use crate::text::told;
use crate::trigger::{Events, Happened, Trigger};
use crate::{inspect, json, substeps};
use dla::{Event, Node, Samples, Schedule, State, Subject, Substeps, Trajectory, View};
use harness::{Again, EVENT_SAMPLES, Method, Progress, Request, Watched, recommend, run_observed, run_watched};
use indicatif::ProgressBar;
use scene::{AnyScene, Column, RunSettings, SceneSystem, TextMechanics, Visitor, with_text};
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
pub fn run(scene: &AnyScene, request: &RunRequest, caller: &Caller) -> Result<RunResult, RunError> {
    let settings = scene.run();
    let method = Method::named(&settings.method, settings.alpha).map_err(|error| RunError::request(&error))?;
    let method = if request.substep { method.with_substeps(Substeps::default()) } else { method };
    let run = Run { name: scene.name(), settings, request, method, caller };
    match scene {
        AnyScene::Sleigh(scene) if scene.has_trailers() => {
            Err(RunError::request(&"trains are run by the command line: their nodes are not kept in memory here"))
        }
        AnyScene::Sleigh(scene) => scene.visit(run).map_err(|error| RunError::request(&error))?,
        AnyScene::Text(scene) => {
            let system = crate::text::system(scene).map_err(|error| RunError::request(&error))?;
            with_text!(system, started => run.of_text(&*started.system, started.q, started.v))
        }
    }
}

struct Run<'a> {
    name: &'a str,
    settings: &'a RunSettings,
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

/// A run that was made, and the nodes that were asked for.
struct Made<const N: usize, const M: usize> {
    watched: Watched<N, M>,
    sampled: Vec<Node<N, M>>,
}

impl<const N: usize, const M: usize> Made<N, M> {
    fn nodes(&self) -> &[Node<N, M>] {
        self.watched.trajectory.as_ref().map_or(&self.sampled[..], Trajectory::nodes)
    }

    fn result(self, (columns, rows): (Vec<Column>, Vec<Vec<f64>>), mut object: Value) -> RunResult {
        let record = &self.watched.record;
        substeps::add_json(&mut object, record);
        let numbers = (0..columns.len()).map(|k| rows.iter().map(|row| row[k]).collect()).collect();
        RunResult { columns, numbers, object, failure: substeps::failure(record), interrupted: record.interrupted }
    }
}

impl Run<'_> {
    fn schedule<const N: usize, const M: usize>(
        &self,
        subject: Subject<'_, N, M>,
        start: ([f64; N], [f64; N]),
    ) -> Result<Schedule, RunError> {
        let schedule = inspect::steps_of(self.settings);
        let Some(tolerance) = self.request.tolerance else { return Ok(schedule) };
        let found = recommend(subject, &self.method.undivided(), start, self.settings.duration, tolerance);
        let found = found.map_err(|error| RunError { message: error.to_string(), request: false })?;
        Ok(Schedule { step: found.step, steps: found.steps, ..schedule })
    }

    fn make<const N: usize, const M: usize>(
        &self,
        subject: Subject<'_, N, M>,
        (q, v): ([f64; N], [f64; N]),
        events: &[Event<'_, N>],
    ) -> Result<Made<N, M>, RunError> {
        let request = Request { schedule: self.schedule(subject, (q, v))?, q, v, samples: 1 };
        let bar = self.caller.bar(self.method.info().name, request.schedule.steps);
        let mut shown = Shown { bar, caller: self.caller };
        let (Self { method, .. }, RunRequest { every, times, .. }) = (self, self.request);
        let looked_for = (events, EVENT_SAMPLES);
        if times.is_empty() {
            let watched = run_watched(subject, method, &request, looked_for, Some(*every), &mut shown);
            return Ok(Made { watched, sampled: Vec::new() });
        }
        let mut samples = Samples::new(Again { method, own: subject.own }, times);
        let watched = run_observed(subject, method, &request, looked_for, &mut samples, &mut shown);
        // The motion at the times asked for, up to where the run comes; the work is not known there.
        let node = |(t, state): (&f64, &State<N>)| {
            let piece = subject.system.smooth_piece(*t);
            let view = View { system: &*piece, k: 0, t: *t, state };
            let (q, v, energy, constraint) = (state.unwrapped(), *state.v(), view.energy(), view.constraint());
            Node { k: 0, t: *t, q, v, energy, work: f64::NAN, constraint, multipliers: None }
        };
        let sampled = times.iter().zip(samples.taken()).map(node).collect();
        Ok(Made { watched, sampled })
    }

    fn of_text<const N: usize, const M: usize>(
        &self,
        system: &dyn TextMechanics<N, M>,
        q: [f64; N],
        v: [f64; N],
    ) -> Result<RunResult, RunError> {
        if !self.request.events.is_empty() || !self.request.until.is_empty() {
            return Err(RunError::request(&"events are quantities of a sleigh, which a system of text does not have"));
        }
        let made = self.make(system.into(), (q, v), &[])?;
        let record = &made.watched.record;
        let object = json::record_of(self.name, record, &told::json(system.model(), record.t, &record.q, &record.v));
        let columns = told::columns(system, 0.0, (&q, &v));
        let rows = made.nodes().iter().map(|node| told::row(system, node)).collect();
        Ok(made.result((columns, rows), object))
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
        let (reported, ending) = (triggers(&self.request.events)?, triggers(&self.request.until)?);
        let ends = ending.iter().map(|trigger| trigger.event(system).terminal());
        let events: Vec<_> = reported.iter().map(|trigger| trigger.event(system)).chain(ends).collect();
        let made = self.make((&system).into(), (q, v), &events)?;
        let Watched { record, crossings, close, .. } = &made.watched;
        let mut object = json::record(self.name, record, &system.sleigh_state(&record.q, &record.v));
        let looked_for: Vec<&Trigger> = reported.iter().chain(&ending).collect();
        if !looked_for.is_empty() {
            let happened = crossings.iter().filter_map(|crossing| Happened::of(system, &looked_for, crossing));
            Events::new(happened, *close).add_to(&mut object);
        }
        let columns = made.nodes().first().map_or_else(Vec::new, |first| system.columns(first));
        let rows = made.nodes().iter().map(|node| system.row(node)).collect();
        Ok(made.result((columns, rows), object))
    }
}
