//! A run of a scene, shared by every output and every kind of scene.

use crate::error::CliError;
use crate::table::number;
use crate::trigger::{Events, Trigger, WatchedTrigger};
use crate::{json, substeps, train};
use dla::{Close, Event, Node, Observer, Schedule, fitted};
use harness::{Method, Progress, Record, Request, Run, SavedCrossing};
use scene::{AnyScene, Built};
use serde_json::{Value, json};

/// A run to be made.
pub(crate) struct Account<'a> {
    pub(crate) system: &'a Built<'a>,
    pub(crate) scene: &'a AnyScene,
    pub(crate) method: &'a Method,
    pub(crate) request: Request,
    /// The reported events, then the `ends` events that end the run.
    watched: Vec<WatchedTrigger<'a>>,
    ends: usize,
}

/// A run that was made.
pub(crate) struct Made {
    pub(crate) record: Record,
    /// The events found; `None` if no event is looked for.
    pub(crate) events: Option<Events>,
}

impl<'a> Account<'a> {
    /// A run of `scene` from the state `(q, v)`, forward or backward in time. A `tolerance` (m or rad) replaces the scene's step by the
    /// longest one that meets it, and `search` shows the trials. An adaptive method must already aim for the tolerance.
    ///
    /// # Errors
    /// [`CliError`] if the system has no such quantity, or no step meets the tolerance.
    pub(crate) fn new(
        system: &'a Built<'a>,
        (scene, method): (&'a AnyScene, &'a Method),
        (q, v): (&[f64], &[f64]),
        (tolerance, backward): (Option<f64>, bool),
        (reported, ending): (&'a [Trigger], &'a [Trigger]),
        search: &mut dyn Progress,
    ) -> Result<Self, CliError> {
        let watched = reported.iter().chain(ending).map(|trigger| trigger.on(system)).collect::<Result<_, _>>()?;
        let mut schedule = scene.schedule();
        if backward {
            let run = scene.run();
            let whole = Schedule { t0: 0.0, step: -run.actual_step(), steps: run.steps() };
            schedule = fitted(&whole, run.step, system.mechanism().jump_times(-run.duration, 0.0));
        }
        if backward && tolerance.is_some() && !method.is_adaptive() {
            let problem = "--tolerance chooses no step for a run backward in time: give --step";
            return Err(CliError::Request(problem.to_owned()));
        }
        if let Some(tolerance) = tolerance.filter(|_| !method.is_adaptive()) {
            // The step is chosen without substeps: they would make any step look good enough.
            let whole = method.undivided();
            let mechanism = system.mechanism();
            let run = Run::of(&*mechanism, &whole).progress(search);
            let found = run.recommended((q, v), (scene.run().duration, tolerance));
            let found = found.map_err(|error| CliError::Tolerance(Box::new(error)))?;
            schedule = Schedule { step: found.step, steps: found.steps, ..schedule };
        }
        let request = Request { schedule, q: q.to_vec(), v: v.to_vec(), samples: 1 };
        Ok(Self { system, scene, method, request, watched, ends: ending.len() })
    }

    /// The first node; only its time and state are set.
    pub(crate) fn start(&self) -> Node {
        let Request { schedule, q, v, .. } = &self.request;
        let (q, v) = (q.clone(), v.clone());
        Node { k: 0, t: schedule.t0, q, v, energy: 0.0, work: 0.0, constraint: 0.0, position: None, multipliers: None }
    }

    /// The events of the run.
    pub(crate) fn events(&self) -> Vec<Event<'_>> {
        let (reported, ending) = self.watched.split_at(self.watched.len() - self.ends);
        let ends = ending.iter().map(|watched| watched.event(self.system).terminal());
        reported.iter().map(|watched| watched.event(self.system)).chain(ends).collect()
    }

    /// The events and the samples per step, for the identity of a saved run; `None` if no event is looked for.
    pub(crate) fn events_identity(&self, samples: u32) -> Option<String> {
        let names: Vec<&str> = self.watched.iter().map(WatchedTrigger::text).collect();
        let ends = if self.ends == 0 { String::new() } else { format!(", the last {} end the run", self.ends) };
        let parts = if samples == harness::EVENT_SAMPLES { String::new() } else { format!(", {samples} samples") };
        (!names.is_empty()).then(|| names.join(", ") + &ends + &parts)
    }

    /// The events found, in words and numbers; `None` if no event is looked for.
    pub(crate) fn happened(&self, crossings: &[SavedCrossing], close: Option<Close>) -> Option<Events> {
        (!self.watched.is_empty()).then(|| Events::of(self.system, &self.watched, crossings, close))
    }

    /// Makes the run, and searches each step for events in `samples` parts.
    pub(crate) fn observed(&self, samples: u32, observer: &mut dyn Observer, progress: &mut dyn Progress) -> Made {
        let events = self.events();
        let mechanism = self.system.mechanism();
        let run = Run::of(&*mechanism, self.method).events(&events, samples).observe(observer).progress(progress);
        let made = run.go(&self.request);
        Made { record: made.record, events: self.happened(&made.crossings, made.close) }
    }

    /// The object of `run --json`.
    pub(crate) fn object(&self, made: &Made) -> Value {
        let Made { record, events } = made;
        let mut object = json::record_of(self.scene.name(), record, &state(self.system, record));
        substeps::add_json(&mut object, record);
        if let Some(train) = self.system.train() {
            train::add_json(&mut object, train, record);
        }
        if let Some(events) = events {
            events.add_to(&mut object);
        }
        object
    }

    /// The state at the end of a run, one line per number. A sleigh has its own table.
    pub(crate) fn end(&self, record: &Record) -> Vec<(String, String)> {
        if let Some(system) = self.system.sleigh() {
            return crate::table::end_of_sleigh(&system.sleigh_state(&record.q, &record.v));
        }
        let line = |value: f64, unit: &str| format!("{} {unit}", number(value)).trim_end().to_owned();
        let state = self.system.state(record.t, &record.q, &record.v).into_iter();
        state.map(|(quantity, value)| (quantity.name, line(value, &quantity.unit))).collect()
    }
}

/// Where a run ends, by name.
pub(crate) fn state(system: &Built<'_>, record: &Record) -> Value {
    let mut end = json!({"t": record.t});
    for (quantity, value) in system.state(record.t, &record.q, &record.v) {
        end[quantity.name] = json!(value);
    }
    end
}
