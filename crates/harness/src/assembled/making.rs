use super::meter::Meter;
use super::{Assembled, assembly_method};
use crate::{Method, MethodInfo, Progress, Record};
use assembly::{Assembly, OneStep, RunError, State, StepReport};
use dla::{Checkpoint, CheckpointError, Schedule};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// A run of an assembly while it is made.
pub(super) struct Making<'a> {
    assembly: &'a Assembly,
    schedule: &'a Schedule,
    info: MethodInfo,
    method: Option<Box<dyn OneStep>>,
    meter: Meter,
    state: State,
    pub(super) made: u64,
    seconds: f64,
    /// The time of the last node, where an event has ended the run there.
    ended: Option<f64>,
    failure: Option<RunError>,
}

/// A step that was made.
pub(super) struct Step<'a> {
    /// The number of the node it began at, and the time (s).
    pub(super) k: u64,
    pub(super) t0: f64,
    pub(super) h: f64,
    pub(super) before: &'a State,
    pub(super) after: &'a State,
}

/// The node at which a run ends within a step: the time (s) and the state.
pub(super) type Last = (f64, State);

impl<'a> Making<'a> {
    pub(super) fn new(
        assembly: &'a Assembly,
        method: &Method,
        schedule: &'a Schedule,
        start: &State,
        every: u64,
    ) -> Self {
        let meter = Meter::new(assembly, schedule.t0, start, every.max(1));
        Self::of(assembly, method, schedule, (meter, start.clone(), 0, 0.0))
    }

    fn of(
        assembly: &'a Assembly,
        method: &Method,
        schedule: &'a Schedule,
        (meter, state, made, seconds): (Meter, State, u64, f64),
    ) -> Self {
        let (method, info) = (assembly_method(assembly, method), method.info());
        let (method, failure) = match method {
            Ok(method) => (Some(method), None),
            Err(source) => (None, Some(RunError { step: 1, time: schedule.t0, source })),
        };
        Self { assembly, schedule, info, method, meter, state, made, seconds, ended: None, failure }
    }

    pub(super) fn failed(&self) -> bool {
        self.failure.is_some()
    }

    /// Whether nothing is left to be done.
    pub(super) fn is_over(&self) -> bool {
        self.failure.is_some() || self.ended.is_some() || self.made == self.schedule.steps
    }

    /// Makes steps up to number `to`, as far as the ticker, a failure or what looks on lets it come.
    pub(super) fn go(
        &mut self,
        to: u64,
        ticker: &mut Ticker<'_>,
        mut look: impl FnMut(&mut dyn OneStep, Step<'_>) -> ControlFlow<Last>,
    ) {
        let Self { assembly, schedule, method: Some(method), meter, state, made, seconds, .. } = self else { return };
        let mut before = state.clone();
        while *made < to && !ticker.stopped {
            let (k, t0, h, clock) = (*made, schedule.time(*made), schedule.step, Instant::now());
            before.copy_from(state);
            let report = match method.step(assembly, t0, h, state) {
                Ok(report) => report,
                Err(source) => {
                    let source = source.named(assembly, t0, state);
                    self.failure = Some(RunError { step: k + 1, time: t0, source });
                    return;
                }
            };
            *seconds += clock.elapsed().as_secs_f64();
            *made += 1;
            let step = Step { k, t0, h, before: &before, after: state };
            if let ControlFlow::Break((t, last)) = look(method.as_mut(), step) {
                // What the shorter step did that ends there, not the whole one.
                let unknown = StepReport { work: None, ..report };
                let shorter = method.step(assembly, t0, t - t0, &mut before.clone());
                *state = last;
                self.ended = Some(t);
                meter.see(assembly, *made, (t0, &before), (t, state), &shorter.unwrap_or(unknown));
                return;
            }
            meter.see(assembly, *made, (t0, &before), (schedule.time(*made), state), &report);
            ticker.stops(*made);
        }
    }

    /// What came of it.
    pub(super) fn assembled(mut self, stopped: bool) -> Assembled {
        let interrupted = stopped && !self.is_over();
        let t = self.ended.unwrap_or_else(|| self.schedule.time(self.made));
        self.meter.finish(self.assembly, t, &self.state);
        let cost = (t, self.made, self.seconds);
        let record = self.meter.record(self.info, self.schedule.step, cost, &self.state, self.failure.as_ref());
        let record = Record { interrupted, ..record };
        Assembled { record, nodes: self.meter.nodes, end: self.state, failure: self.failure }
    }

    /// All from which the run goes on.
    pub(super) fn checkpoint(&self, identity: &Checkpoint) -> Checkpoint {
        let mut checkpoint = identity.clone();
        checkpoint.put_counts("k", &[self.made]);
        checkpoint.put("seconds", &[self.seconds]);
        self.state.save(&mut checkpoint);
        self.meter.save(&mut checkpoint);
        checkpoint
    }

    /// The run that [`checkpoint`](Self::checkpoint) wrote.
    pub(super) fn load(
        assembly: &'a Assembly,
        method: &Method,
        schedule: &'a Schedule,
        every: u64,
        checkpoint: &Checkpoint,
    ) -> Result<Self, CheckpointError> {
        let ([made], [seconds]) = (checkpoint.counts("k")?, checkpoint.get("seconds")?);
        let state = State::load(checkpoint, assembly)?;
        let meter = Meter::load(checkpoint, every.max(1))?;
        Ok(Self::of(assembly, method, schedule, (meter, state, made, seconds)))
    }
}

/// Tells a [`Progress`] now and then: a step may take long.
pub(super) struct Ticker<'a> {
    progress: &'a mut dyn Progress,
    told: u64,
    clock: Instant,
    pub(super) stopped: bool,
}

impl<'a> Ticker<'a> {
    const EVERY: Duration = Duration::from_millis(50);

    /// Of a run that has made so many steps already.
    pub(super) fn new(progress: &'a mut dyn Progress, told: u64) -> Self {
        Self { progress, told, clock: Instant::now(), stopped: false }
    }

    /// Whether the run is to end, after so many steps.
    pub(super) fn stops(&mut self, made: u64) -> bool {
        if self.clock.elapsed() >= Self::EVERY {
            self.finish(made);
            self.stopped = self.progress.stops();
            self.clock = Instant::now();
        }
        self.stopped
    }

    pub(super) fn finish(&mut self, made: u64) {
        self.progress.advance(made - self.told);
        self.told = made;
    }
}
