use crate::timing::{Stopper, Ticker, median_seconds};
use crate::{Method, Progress, Record, SavedCrossing, Saving};
use dla::{
    AnyState, CheckpointError, Close, Event, Mechanism, Nodes, Observer, Piece, RecommendError, Recommendation,
    RunError, Samples, Schedule, piece_by_piece, recommend_by_trial, substepped_part,
};

/// The start of a measured run, and its steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The schedule of the steps.
    pub schedule: Schedule,
    /// Configuration at the start.
    pub q: Vec<f64>,
    /// Velocity at the start.
    pub v: Vec<f64>,
    /// Approximate number of nodes to keep for plots.
    pub samples: u64,
}

/// A measured run, with the events that happened.
#[derive(Debug, Clone)]
pub struct Made {
    /// The record; if an event ended the run, its end is the event.
    pub record: Record,
    /// The events, in the order of time, also the ones before a checkpoint.
    pub crossings: Vec<SavedCrossing>,
    /// Crossings so close that others may have been missed.
    pub close: Option<Close>,
}

/// Default number of parts into which a step is divided to look for events ([`Watch::samples`](dla::Watch::samples)).
pub const EVENT_SAMPLES: u32 = 4;

/// A run of a method on a system whose forces or constraints may jump, made with one smooth piece after the other.
///
/// ```
/// # use dla::{Schedule, Subject, Trajectory};
/// # use harness::{Method, Request, Run};
/// # let sleigh = sleigh::Sleigh::new(1.0, 1.0, 0.5)?;
/// let (system, method) = (Subject::from(&sleigh), Method::named("gauss8", None)?);
/// let schedule = Schedule { t0: 0.0, step: 0.05, steps: 400 };
/// let start = Request { schedule, q: vec![0.0; 3], v: vec![1.0, 0.0, 0.3], samples: 10 };
/// let mut nodes = Trajectory::every(10);
/// let made = Run::of(&system, &method).observe(&mut nodes).go(&start);
/// assert!(made.record.constraint_max < 1e-14 && nodes.nodes().len() == 41);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Run<'a> {
    pub(crate) system: &'a dyn Mechanism,
    pub(crate) method: &'a Method,
    pub(crate) events: &'a [Event<'a>],
    pub(crate) event_samples: u32,
    pub(crate) observer: Option<&'a mut dyn Observer>,
    pub(crate) progress: Option<&'a mut dyn Progress>,
    after: u64,
}

impl<'a> Run<'a> {
    /// A run that nobody looks at.
    #[must_use]
    pub fn of(system: &'a dyn Mechanism, method: &'a Method) -> Self {
        Self { system, method, events: &[], event_samples: EVENT_SAMPLES, observer: None, progress: None, after: 0 }
    }

    /// Shows every node to an observer.
    #[must_use]
    pub fn observe(self, observer: &'a mut dyn Observer) -> Self {
        Self { observer: Some(observer), ..self }
    }

    /// Tells how far it has come, and ends if the caller asks for that.
    #[must_use]
    pub fn progress(self, progress: &'a mut dyn Progress) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Looks for events, in the given number of parts of each step; only if it is measured.
    #[must_use]
    pub fn events(self, events: &'a [Event<'a>], samples: u32) -> Self {
        Self { events, event_samples: samples, ..self }
    }

    /// Goes on after `steps` steps of its schedule; only if it [moves](Self::moves) a state.
    #[must_use]
    pub fn after(self, steps: u64) -> Self {
        Self { after: steps, ..self }
    }

    /// Moves a state along the schedule and measures nothing; returns the number of steps made since the start of the schedule.
    ///
    /// # Errors
    /// [`RunError`] with the step that failed; `state` is then the last good node. A run with fewer steps than pieces is refused before
    /// the first step is made.
    pub fn moves(self, schedule: &Schedule, state: &mut AnyState) -> Result<u64, RunError> {
        let Self { method, after, .. } = self;
        let mut observer = (self.observer, self.progress.map(|progress| Ticker::new(progress, 0)));
        piece_by_piece(after, self.system, schedule, state, |piece, Piece { steps, schedule }, state| {
            // A method for each piece: its memory does not hold across a jump.
            let mut integrator = piece.integrator(method);
            substepped_part(piece, &mut *integrator, method.substeps(), &schedule, steps, state, &mut observer)
        })
    }

    /// Makes the run, once, and measures it with its observers.
    ///
    /// A run that fails gives the record of its valid part, with [`Record::failure`] set.
    #[must_use]
    pub fn go(mut self, request: &Request) -> Made {
        let mut progress = self.progress.take();
        self.measured(request, None, &mut progress)
    }

    /// As [`go`](Self::go), and makes checkpoints or goes on from one.
    ///
    /// The record is the same to the last bit whether the run was made at once or in parts, except for its time, which is the sum over all
    /// parts, with the observers; so are the nodes, of which a resumed run shows the ones after the checkpoint. A run may be resumed with
    /// more steps than it had. If the progress ends the run, a last checkpoint is made; so is one at its end, from which the same record
    /// comes again at once, and one at its start if an event ends it before any other. The event that ends a run is found again from the
    /// last checkpoint before it; the identity must name the events and their samples.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint does not belong to this run; nothing is then done.
    pub fn saved(
        mut self,
        request: &Request,
        saving: &mut Saving<'_>,
        nodes: Option<Nodes<'_>>,
    ) -> Result<Made, CheckpointError> {
        let from = saving.loaded(self.system, self.method, request)?;
        let mut progress = self.progress.take();
        Ok(self.measured(request, Some((saving, from, nodes)), &mut progress))
    }

    /// Makes the run twice, once observed and once timed without observers, and measures it.
    #[must_use]
    pub fn timed(mut self, request: &Request) -> Record {
        let (system, method, mut progress) = (self.system, self.method, self.progress.take());
        let record = self.measured(request, None, &mut progress).record;
        let wall_seconds = Run::of(system, method).progress(&mut progress).seconds(request, record.steps);
        Record { wall_seconds, ..record }
    }

    /// The time of steps that have been made before, without observers (s): the processor's, for this thread.
    ///
    /// For more than 2^22 steps, the time of the first 2^22 is scaled by the ratio: a long run costs hardly more for being timed.
    #[must_use]
    pub fn seconds(self, request: &Request, steps: u64) -> f64 {
        /// Number of first steps that are timed in a longer run.
        const TIMED: u64 = 1 << 22;
        let first = Schedule { steps: steps.min(TIMED), ..request.schedule };
        let start = self.system.state(&request.q, &request.v);
        let mut stopper = Stopper(self.progress.as_deref());
        let mut made = 0;
        let seconds = median_seconds(|| {
            let mut state = std::hint::black_box(&start).clone();
            let run = Run::of(self.system, self.method).observe(&mut stopper);
            // The observed run has just shown that these steps succeed.
            made = run.moves(&first, &mut state).unwrap_or(first.steps);
            std::hint::black_box(state);
        });
        if made == steps { seconds } else { seconds * steps as f64 / made.max(1) as f64 }
    }

    /// The longest step of a whole run from time zero that meets a tolerance (see [`dla::recommend_by_trial`]). The progress is told of the
    /// steps of each trial.
    ///
    /// # Errors
    /// [`RecommendError`], with the best that is within reach.
    pub fn recommended(
        self,
        (q, v): (&[f64], &[f64]),
        (duration, tolerance): (f64, f64),
    ) -> Result<Recommendation, RecommendError> {
        let Self { system, method, mut progress, .. } = self;
        recommend_by_trial(duration, tolerance, |schedule, times| {
            let mut samples = Samples::new(method, times);
            let mut run = Run::of(system, method).observe(&mut samples);
            if let Some(progress) = progress.as_deref_mut() {
                progress.expect(schedule.steps);
                run = run.progress(progress);
            }
            run.moves(schedule, &mut system.state(q, v))?;
            let taken = samples.into_taken();
            let taken = taken.map_err(|source| RunError::new(schedule.steps, schedule.t0, source))?;
            Ok(taken.iter().map(AnyState::unwrapped).collect())
        })
    }
}

impl std::fmt::Debug for Run<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Run").field("method", self.method).finish_non_exhaustive()
    }
}
