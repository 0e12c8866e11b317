use super::AssemblyNodes;
use super::meter::AssemblyMeter;
use super::parts::{Parted, in_parts, resolves, shorter};
use super::step::{AssemblyStep, LastNode};
use super::{Assembled, assembly_method};
use crate::{Method, MethodInfo, Progress, Record};
use assembly::{Assembly, AssemblyMethod, AssemblyRunError, AssemblyState};
use dla::{Checkpoint, CheckpointError, Schedule, Substeps};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// A run of an assembly while it is made.
pub(super) struct Making<'a, 'n> {
    assembly: &'a Assembly,
    schedule: &'a Schedule,
    info: MethodInfo,
    limits: Option<Substeps>,
    method: Option<Box<dyn AssemblyMethod>>,
    meter: AssemblyMeter<'n>,
    state: AssemblyState,
    pub(super) made: u64,
    seconds: f64,
    /// The time of the last node, where an event has ended the run there.
    ended: Option<f64>,
    failure: Option<AssemblyRunError>,
}

impl<'a, 'n> Making<'a, 'n> {
    pub(super) fn new(
        assembly: &'a Assembly,
        method: &Method,
        schedule: &'a Schedule,
        start: &AssemblyState,
        nodes: AssemblyNodes<'n>,
    ) -> Self {
        let meter = AssemblyMeter::new(assembly, method, schedule.t0, start, nodes);
        Self::of(assembly, method, schedule, (meter, start.clone(), 0, 0.0))
    }

    fn of(
        assembly: &'a Assembly,
        method: &Method,
        schedule: &'a Schedule,
        (meter, state, made, seconds): (AssemblyMeter<'n>, AssemblyState, u64, f64),
    ) -> Self {
        let (method, info, limits) = (assembly_method(assembly, method), method.info(), method.substeps());
        let (method, failure) = match method {
            Ok(method) => (Some(method), None),
            Err(source) => (None, Some(AssemblyRunError { step: 1, time: schedule.t0, source })),
        };
        Self { assembly, schedule, info, limits, method, meter, state, made, seconds, ended: None, failure }
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
        ticker: &mut AssemblyTicker<'_>,
        mut look: impl FnMut(&mut dyn AssemblyMethod, AssemblyStep<'_>) -> ControlFlow<LastNode>,
    ) {
        let Self { assembly, schedule, limits, method: Some(method), meter, state, made, seconds, .. } = self else {
            return;
        };
        let mut before = state.clone();
        while *made < to && !ticker.stopped {
            let (k, t0, h, clock) = (*made, schedule.time(*made), schedule.step, Instant::now());
            before.copy_from(state);
            let whole = method.step(assembly, t0, h, state).and_then(|report| {
                // Only a step that may be divided is asked whether it resolves the motion.
                limits.map_or(Ok(()), |_| resolves(assembly, method.as_mut(), (t0, h), (&before, state)))?;
                Ok(report)
            });
            *seconds += clock.elapsed().as_secs_f64();
            let Parted { last, iterations, parts } = match (whole, *limits) {
                (Ok(report), _) => {
                    let iterations = report.iterations;
                    let step = AssemblyStep { k, t0, h, before: &before, after: state };
                    let last = match look(method.as_mut(), step) {
                        ControlFlow::Continue(()) => {
                            meter.over(assembly, (t0, &before), (schedule.time(k + 1), state), &report);
                            None
                        }
                        ControlFlow::Break((t, last)) => {
                            let shorter = shorter(assembly, method.as_mut(), (t0, t), &before, report);
                            meter.over(assembly, (t0, &before), (t, &last), &shorter);
                            Some((t, last))
                        }
                    };
                    Parted { last, iterations, parts: 0 }
                }
                (Err(source), None) => {
                    let source = source.named(assembly, t0, state);
                    self.failure = Some(AssemblyRunError { step: k + 1, time: t0, source });
                    return;
                }
                (Err(source), Some(limits)) => {
                    state.copy_from(&before);
                    let (work, clock) = (meter.work(), Instant::now());
                    let (step, stops) = ((limits, (k, t0, h), source), || ticker.asked());
                    let parted = in_parts(assembly, method.as_mut(), step, (state, meter), stops, &mut look);
                    *seconds += clock.elapsed().as_secs_f64();
                    let Ok(Some(parted)) = parted else {
                        state.copy_from(&before);
                        meter.back_to(work);
                        match parted {
                            Err(undivided) => {
                                meter.undivided(&undivided);
                                self.failure =
                                    Some(AssemblyRunError { step: k + 1, time: t0, source: undivided.source });
                            }
                            Ok(_) => ticker.stopped = true,
                        }
                        return;
                    };
                    parted
                }
            };
            *made += 1;
            if let Some((t, last)) = last {
                *state = last;
                self.ended = Some(t);
                meter.see(assembly, (*made, t), state, iterations, parts);
                return;
            }
            meter.see(assembly, (*made, schedule.time(*made)), state, iterations, parts);
            ticker.stops(*made);
        }
    }

    /// What came of it.
    pub(super) fn assembled(mut self, stopped: bool) -> Assembled {
        let interrupted = stopped && !self.is_over();
        let t = self.ended.unwrap_or_else(|| self.schedule.time(self.made));
        self.meter.finish(self.assembly, (self.made, t), &self.state);
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
        nodes: AssemblyNodes<'n>,
        checkpoint: &Checkpoint,
    ) -> Result<Self, CheckpointError> {
        let ([made], [seconds]) = (checkpoint.counts("k")?, checkpoint.get("seconds")?);
        let state = AssemblyState::load(checkpoint, assembly)?;
        let meter = AssemblyMeter::load(checkpoint, method, (made, schedule.time(made)), nodes)?;
        Ok(Self::of(assembly, method, schedule, (meter, state, made, seconds)))
    }
}

/// Tells a [`Progress`] now and then: a step may take long.
pub(super) struct AssemblyTicker<'a> {
    progress: &'a mut dyn Progress,
    told: u64,
    clock: Instant,
    pub(super) stopped: bool,
}

impl<'a> AssemblyTicker<'a> {
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

    /// The same within a step, of which nothing is told.
    pub(super) fn asked(&self) -> bool {
        self.progress.stops()
    }

    pub(super) fn finish(&mut self, made: u64) {
        self.progress.advance(made - self.told);
        self.told = made;
    }
}
