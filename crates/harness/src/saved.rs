use crate::record::Meter;
use crate::timing::Ticker;
use crate::{Made, Method, Progress, Record, Request, Run};
use dla::{
    AnyState, Checkpoint, CheckpointError, Close, Crossing, Event, Mechanism, Nodes, Part, Piece, Watch, Work,
    close_crossings, piece_by_piece, substepped_part,
};
use std::ops::Range;
use std::time::Instant;

/// How a run is saved, and the checkpoint from which it is resumed.
pub struct Saving<'a> {
    /// A checkpoint without numbers that identifies the run.
    pub identity: &'a Checkpoint,
    /// The checkpoint to go on from; `None` begins at the start.
    pub from: Option<&'a Checkpoint>,
    /// Number of steps between checkpoints; `None` makes no checkpoints.
    pub every: Option<u64>,
    /// Receives every checkpoint.
    pub save: &'a mut dyn FnMut(&Checkpoint),
}

/// An event that happened, as a run and its checkpoints keep it.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedCrossing {
    /// The index of the event.
    pub event: usize,
    /// The node before it.
    pub k: u64,
    /// The time (s).
    pub t: f64,
    /// The interval of time that is known to hold the change of sign (s).
    pub within: f64,
    /// The spacing of the samples that found it (s).
    pub spacing: f64,
    /// Whether the function rises through zero.
    pub rising: bool,
    /// The configuration then, angles with their turns.
    pub q: Vec<f64>,
    /// The velocity then.
    pub v: Vec<f64>,
}

/// The numbers of a crossing beside its state.
const BESIDE: usize = 6;

impl From<&Crossing> for SavedCrossing {
    fn from(found: &Crossing) -> Self {
        let Crossing { event, k, t, within, spacing, rising, ref state } = *found;
        Self { event, k, t, within, spacing, rising, q: state.unwrapped(), v: state.v().to_vec() }
    }
}

impl SavedCrossing {
    fn numbers(&self) -> Vec<f64> {
        let rising = f64::from(u8::from(self.rising));
        let beside = [self.event as f64, self.k as f64, self.t, self.within, self.spacing, rising];
        beside.iter().chain(&self.q).chain(&self.v).copied().collect()
    }

    /// All crossings in a checkpoint of a system of `n` coordinates; an incomplete last one is left out.
    fn all(numbers: &[f64], n: usize) -> Vec<Self> {
        let one = |numbers: &[f64]| {
            let (beside, state) = numbers.split_first_chunk::<BESIDE>()?;
            let (q, v) = state.split_at_checked(n)?;
            let [event, k, t, within, spacing, rising] = *beside;
            let (q, v) = (q.to_vec(), v.to_vec());
            Some(Self { event: event as usize, k: k as u64, t, within, spacing, rising: rising != 0.0, q, v })
        };
        numbers.chunks_exact(BESIDE + 2 * n).filter_map(one).collect()
    }
}

/// Everything that changes along a run.
pub(crate) struct Progressing {
    made: u64,
    /// The time (s).
    t: f64,
    state: AnyState,
    memory: Vec<f64>,
    meter: Meter,
    seconds: f64,
    crossings: Vec<SavedCrossing>,
    /// See [`Close::incomplete`].
    incomplete: u64,
}

/// The part of a run that a checkpoint has, with its work.
pub(crate) type Loaded = (Progressing, Work);

impl Saving<'_> {
    /// The part of the run that is made already; `None` without a step: such a run starts again, and its first node is shown.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint does not belong to this run.
    pub(crate) fn loaded(
        &self,
        system: &dyn Mechanism,
        method: &Method,
        request: &Request,
    ) -> Result<Option<Loaded>, CheckpointError> {
        let Some(checkpoint) = self.from else { return Ok(None) };
        checkpoint.belongs_to(self.identity)?;
        let [made] = checkpoint.counts("k")?;
        let steps = request.schedule.steps;
        if made > steps {
            let what = "number of steps that are made".to_owned();
            return Err(CheckpointError::Other { what, found: made.to_string(), expected: format!("at most {steps}") });
        }
        let loaded = Progressing::load(checkpoint, system, Meter::new(request, method))?;
        Ok(Some(loaded).filter(|(run, _)| run.made > 0))
    }
}

impl Run<'_> {
    /// Makes a run once and measures it, with checkpoints if there is a [`Saving`].
    pub(crate) fn measured(
        self,
        request: &Request,
        saving: Option<(&mut Saving<'_>, Option<Loaded>, Option<Nodes<'_>>)>,
        progress: &mut dyn Progress,
    ) -> Made {
        let Self { system, method, events, event_samples, mut observer, .. } = self;
        let Request { schedule, ref q, ref v, .. } = *request;
        let (mut saving, loaded, mut nodes) = match saving {
            Some((saving, loaded, nodes)) => (Some(saving), loaded, nodes),
            None => (None, None, None),
        };
        let every = saving.as_ref().and_then(|saving| saving.every);
        let from = saving.as_ref().and_then(|saving| saving.from);
        let empty = Checkpoint::default();
        let identity = saving.as_ref().map_or(&empty, |saving| saving.identity);
        let mut save = |made: &Checkpoint| saving.iter_mut().for_each(|saving| (saving.save)(made));
        let mut run = match loaded {
            Some((run, work)) => {
                nodes = nodes.zip(from).map(|(nodes, from)| nodes.resumed((run.made, run.t), work, from));
                if every.is_some() {
                    save(&run.checkpoint(identity, nodes.as_ref()));
                }
                run
            }
            None => Progressing {
                made: 0,
                t: schedule.t0,
                state: system.state(q, v),
                memory: Vec::new(),
                meter: Meter::new(request, method),
                seconds: 0.0,
                crossings: Vec::new(),
                incomplete: 0,
            },
        };
        // An event may end a run before it is saved.
        let mut start = every.filter(|_| run.made == 0).map(|_| run.checkpoint(identity, nodes.as_ref()));
        progress.advance(run.made);
        let mut ticker = Ticker::new(progress, run.made);
        let (begin, before) = (Instant::now(), run.seconds);
        let (first, mut state) = (run.made, run.state.clone());
        let mut seen = (first > 0).then(|| (run.t, state.clone()));
        let mut stopped = false;
        let ends = |done: &Part| every.is_some() && (done.stopped || done.made == schedule.steps);
        let outcome =
            piece_by_piece(first, system, &schedule, &mut state, |piece, Piece { steps, schedule: times }, state| {
                if steps.start > first {
                    // A piece begins with a new method.
                    run.memory.clear();
                }
                let mut integrator = piece.integrator(method);
                let mut done = Part { made: steps.start, stopped: false };
                for chunk in chunks(&steps, every) {
                    // From what a checkpoint has, so that the run is the same with one.
                    integrator.recall(&run.memory, state);
                    let limits = method.substeps();
                    let inner = (&mut run.meter, ((&mut nodes, &mut observer), &mut ticker));
                    let mut watch = Watch::new(method, events, inner);
                    watch.samples = event_samples;
                    let mut watch = match seen.take() {
                        Some((t, state)) => watch.resumed(t, state),
                        None => watch,
                    };
                    let outcome =
                        substepped_part(piece, &mut *integrator, limits, &times, chunk.clone(), state, &mut watch);
                    run.crossings.extend(watch.crossings().iter().map(SavedCrossing::from));
                    run.incomplete += watch.incomplete();
                    let ended = watch.ended().is_some();
                    done = outcome?;
                    if ended {
                        start.iter().for_each(&mut save);
                        break;
                    }
                    seen = Some((times.time(done.made), state.clone()));
                    run.memory = integrator.memory();
                    // A run that is over has no news, and its checkpoint stays as it is.
                    let news = done.made > first || first == 0;
                    let due = every.is_some_and(|every| done.made.is_multiple_of(every));
                    if news && (due && done.made < schedule.steps || ends(&done)) {
                        if done.made == steps.end && done.made < schedule.steps {
                            run.memory.clear();
                        }
                        (run.made, run.t, run.state) = (done.made, times.time(done.made), state.clone());
                        run.seconds = before + begin.elapsed().as_secs_f64();
                        start = None;
                        save(&run.checkpoint(identity, nodes.as_ref()));
                    }
                    if done.stopped {
                        stopped = true;
                        break;
                    }
                }
                Ok(done)
            });
        let seconds = before + begin.elapsed().as_secs_f64();
        let interrupted = ticker.stopped || stopped;
        let record = Record { interrupted, ..run.meter.record(method.info(), seconds, outcome.err()) };
        let looked = run.crossings.iter().map(|crossing| (crossing.event, crossing.t, crossing.spacing));
        let close = close_crossings(looked, |event| events.get(event).is_some_and(Event::leaves_some_out));
        let close = Close::with_incomplete(close, run.incomplete);
        Made { record, crossings: run.crossings, close }
    }
}

/// The parts of some steps that end at the multiples of `every`; at least one, even if it is empty.
fn chunks(steps: &Range<u64>, every: Option<u64>) -> Vec<Range<u64>> {
    let mut parts = Vec::new();
    let mut at = steps.start;
    loop {
        let next = every.map_or(steps.end, |every| (at / every).saturating_add(1).saturating_mul(every));
        parts.push(at..next.min(steps.end));
        at = next;
        if at >= steps.end {
            return parts;
        }
    }
}

impl Progressing {
    fn checkpoint(&self, identity: &Checkpoint, nodes: Option<&Nodes<'_>>) -> Checkpoint {
        let mut checkpoint = identity.clone();
        if let Some(nodes) = nodes {
            nodes.save(&mut checkpoint);
        }
        checkpoint.put_counts("k", &[self.made]);
        checkpoint.put("seconds", &[self.seconds]);
        checkpoint.put("time", &[self.t]);
        self.state.save(&mut checkpoint);
        checkpoint.put("memory", &self.memory);
        self.meter.save(&mut checkpoint);
        let crossings: Vec<f64> = self.crossings.iter().flat_map(SavedCrossing::numbers).collect();
        checkpoint.put("crossings", &crossings);
        checkpoint.put_counts("incomplete", &[self.incomplete]);
        checkpoint
    }

    fn load(checkpoint: &Checkpoint, system: &dyn Mechanism, meter: Meter) -> Result<(Self, Work), CheckpointError> {
        let [made] = checkpoint.counts("k")?;
        let ([seconds], [t]) = (checkpoint.get("seconds")?, checkpoint.get("time")?);
        let state = system.load_state(checkpoint)?;
        let work = Work::load(checkpoint, t, &state)?;
        let meter = Meter::load(checkpoint, meter, made, t, &state, work.clone())?;
        let crossings = SavedCrossing::all(&checkpoint.list("crossings")?, state.q().len());
        // A checkpoint of another program may lack this count.
        let [incomplete] = checkpoint.counts("incomplete").unwrap_or([0]);
        Ok((Self { made, t, state, memory: checkpoint.list("memory")?, meter, seconds, crossings, incomplete }, work))
    }
}

impl std::fmt::Debug for Saving<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Saving").field("identity", self.identity).field("every", &self.every).finish_non_exhaustive()
    }
}
