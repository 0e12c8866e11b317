use crate::record::Meter;
use crate::run::integrate_pieces;
use crate::stopwatch::take;
use crate::timing::Ticker;
use crate::{Method, Progress, Record, Request};
use dla::{
    Close, Crossing, Event, Mechanism, Observer, RecommendError, Recommendation, Samples, Trajectory, Watch,
    recommend_by_trial,
};

/// A measured run, with the nodes that were asked for and the events that happened.
#[derive(Debug, Clone)]
pub struct Watched {
    /// The record; if an event ended the run, its end is the event.
    pub record: Record,
    /// The nodes.
    pub trajectory: Option<Trajectory>,
    /// The events, in the order in which they happened.
    pub crossings: Vec<Crossing>,
    /// Crossings so close that others may have been missed.
    pub close: Option<Close>,
}

/// Default number of parts into which a step is divided to look for events ([`Watch::samples`]).
pub const EVENT_SAMPLES: u32 = 4;

/// Makes a run, once, and measures it with its observers; looks for events, in the given number of parts of each step, and keeps every
/// `keep`-th node, if `keep` is given.
pub fn run_watched(
    system: &dyn Mechanism,
    method: &Method,
    request: &Request,
    events: (&[Event<'_>], u32),
    keep: Option<u64>,
    progress: &mut dyn Progress,
) -> Watched {
    let mut trajectory = keep.map(Trajectory::every);
    let made = run_observed(system, method, request, events, &mut trajectory, progress);
    Watched { trajectory, ..made }
}

/// As [`run_watched`], with any observer, which sees the nodes as they come; no nodes are kept.
pub fn run_observed(
    system: &dyn Mechanism,
    method: &Method,
    request: &Request,
    (events, samples): (&[Event<'_>], u32),
    observer: &mut dyn Observer,
    progress: &mut dyn Progress,
) -> Watched {
    let Request { schedule, q, v, .. } = request;
    let mut meter = Meter::new(request, method);
    let mut ticker = Ticker::new(progress, 0);
    let inner = (&mut meter, (observer, &mut ticker));
    let mut watch = Watch::new(method, events, inner);
    watch.samples = samples;
    let mut outcome = Ok(0);
    let mut state = system.state(q, v);
    // The run is made once: its time includes the observers.
    let taken = take(1, || outcome = integrate_pieces(system, method, schedule, &mut state, &mut watch));
    let (crossings, close, ended) = (watch.crossings().to_vec(), watch.close(), watch.ended().is_some());
    let interrupted = ticker.stopped || (outcome.is_ok_and(|made| made < schedule.steps) && !ended);
    let record = Record { interrupted, ..meter.record(method.info(), taken.wall, outcome.err()) };
    Watched { record, trajectory: None, crossings, close }
}

/// The longest step of a whole run from time zero that meets a tolerance (see [`dla::recommend_by_trial`]). `progress` is told of the steps of
/// each trial.
///
/// # Errors
/// [`RecommendError`], with the best that is within reach.
pub fn recommend(
    system: &dyn Mechanism,
    method: &Method,
    (q, v): (&[f64], &[f64]),
    (duration, tolerance): (f64, f64),
    progress: &mut dyn Progress,
) -> Result<Recommendation, RecommendError> {
    recommend_by_trial(duration, tolerance, |schedule, times| {
        let mut samples = Samples::new(method, times);
        let mut state = system.state(q, v);
        progress.expect(schedule.steps);
        let mut ticker = Ticker::new(progress, 0);
        integrate_pieces(system, method, schedule, &mut state, &mut (&mut samples, &mut ticker))?;
        let taken = samples.into_taken();
        let taken = taken.map_err(|source| dla::RunError::new(schedule.steps, schedule.t0, source))?;
        Ok(taken.iter().map(dla::AnyState::unwrapped).collect())
    })
}
