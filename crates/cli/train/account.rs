use crate::account::{backward, no_step_backward};
use crate::error::CliError;
use crate::trigger::{Events, Happened, Trigger, WatchedTriggers};
use crate::{json, substeps};
use assembly::AssemblyState;
use assembly::parts::Train;
use dla::Schedule;
use harness::{Assembled, AssemblyNodes, Method, Progress, recommend_assembly, run_assembly_watched};
use scene::{Scene, SleighQuantity};
use serde_json::{Value, json};
use sleigh::SleighState;

/// A run of a train to be made, wherever its rows go.
pub(super) struct TrainAccount<'a> {
    pub(super) scene: &'a Scene,
    pub(super) train: Train,
    pub(super) start: AssemblyState,
    pub(super) method: &'a Method,
    pub(super) schedule: Schedule,
    /// What is reported, and then what ends the run, from the place `ending` on.
    watched: Vec<WatchedTriggers<'a, SleighQuantity>>,
    ending: usize,
}

/// A run that was made.
pub(super) struct MadeTrain {
    pub(super) run: Assembled,
    /// What happened, where that was asked for.
    pub(super) events: Option<Events>,
}

impl<'a> TrainAccount<'a> {
    /// The run of a train from its start, as [`Account::new`](crate::account::Account::new).
    ///
    /// # Errors
    /// [`CliError`] where the first blade has no such quantity, or no step meets the tolerance.
    pub(super) fn new(
        scene: &'a Scene,
        (train, start): (Train, AssemblyState),
        method: &'a Method,
        (tolerance, is_backward): (Option<f64>, bool),
        (reported, ending): (&'a [Trigger], &'a [Trigger]),
    ) -> Result<Self, CliError> {
        let watched = reported.iter().chain(ending).map(Trigger::on_blade).collect::<Result<_, _>>()?;
        let mut schedule = scene.schedule();
        if is_backward {
            schedule = backward(&scene.run, train.assembly.jump_times(-scene.run.duration, 0.0));
        }
        if let Some(tolerance) = tolerance {
            if is_backward {
                return Err(no_step_backward());
            }
            // Of the method itself: parts would make any step look good enough.
            let (whole, duration) = (method.undivided(), scene.run.duration);
            let seen = |state: &AssemblyState| ends(&train, state);
            let found = recommend_assembly(&train.assembly, &whole, &start, duration, tolerance, seen);
            let found = found.map_err(|error| CliError::Tolerance(Box::new(error)))?;
            schedule = Schedule { step: found.step, steps: found.steps, ..schedule };
        }
        Ok(Self { scene, train, start, method, schedule, watched, ending: reported.len() })
    }

    /// Makes it at once, with an eye on the events in so many parts of each step.
    pub(super) fn watched(&self, samples: u32, nodes: AssemblyNodes<'_>, progress: &mut dyn Progress) -> MadeTrain {
        let Self { train, start, method, schedule, watched, ending, .. } = self;
        let events: Vec<_> = watched.iter().enumerate().map(|(k, one)| one.event(train, k >= *ending)).collect();
        let looked_for = (&events[..], samples);
        let (run, crossings, close) =
            run_assembly_watched(&train.assembly, method, schedule, (start, nodes), looked_for, progress);
        let happened = crossings.iter().filter_map(|crossing| Happened::of_train(train, watched, crossing));
        let events = (!watched.is_empty()).then(|| Events::new(happened, close));
        MadeTrain { run, events }
    }

    /// The first and the last blade at the end of a run.
    pub(super) fn ends(&self, run: &Assembled) -> [SleighState; 2] {
        [0, self.train.trailers().len()].map(|blade| self.train.blade(&run.end, blade))
    }

    /// The object of `run --json`.
    pub(super) fn object(&self, MadeTrain { run, events }: &MadeTrain) -> Value {
        let ([first, last], record) = (self.ends(run), &run.record);
        let mut object = json::record(&self.scene.name, record, &first);
        substeps::add_json(&mut object, record);
        object["constraint"]["leaf_max"] = json!(record.leaf_max);
        object["trailers"] = json!(self.train.trailers().len());
        let SleighState { x, y, heading, speed, turn_rate } = last;
        object["last"] = json!({"x": x, "y": y, "heading": heading, "speed": speed, "turn_rate": turn_rate});
        if let Some(events) = events {
            events.add_to(&mut object);
        }
        object
    }

    /// Why the run failed, where it did, with the hinge that the static record does not know.
    pub(super) fn failure(&self, Assembled { record, failure, .. }: &Assembled) -> Option<String> {
        let told = substeps::failure(record)?;
        Some(match failure {
            Some(error) if !told.contains(&error.source.to_string()) => format!("{told}; {error}"),
            _ => told,
        })
    }
}

/// Place and heading of the first and of the last blade, by which a tolerance is met.
fn ends(train: &Train, state: &AssemblyState) -> [f64; 6] {
    let [first, last] = [0, train.trailers().len()].map(|k| train.blade(state, k));
    [first.x, first.y, first.heading, last.x, last.y, last.heading]
}
