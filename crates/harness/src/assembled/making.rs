use super::meter::AssemblyMeter;
use super::parts::{Parted, in_parts, resolves};
use super::pieces::{AssemblyPieces, PieceStep};
use super::step::{AssemblyStep, LastNode};
use super::{Assembled, AssemblyNodes};
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
    pieces: Option<AssemblyPieces<'a>>,
    meter: AssemblyMeter<'n>,
    state: AssemblyState,
    pub(super) made: u64,
    seconds: f64,
    /// The time of the last node (s).
    t: f64,
    /// Whether an event has ended the run there.
    ended: bool,
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
        let pieces = AssemblyPieces::new(assembly, method, schedule);
        let first = pieces.as_ref().map_or(assembly, AssemblyPieces::assembly);
        let meter = AssemblyMeter::new(first, method, schedule.t0, start, nodes);
        Self::of((assembly, pieces), method, schedule, (meter, start.clone(), 0, 0.0))
    }

    fn of(
        (assembly, pieces): (&'a Assembly, Result<AssemblyPieces<'a>, AssemblyRunError>),
        method: &Method,
        schedule: &'a Schedule,
        (meter, state, made, seconds): (AssemblyMeter<'n>, AssemblyState, u64, f64),
    ) -> Self {
        let (info, limits) = (method.info(), method.substeps());
        let (pieces, failure) = match pieces {
            Ok(pieces) => (Some(pieces), None),
            Err(failure) => (None, Some(failure)),
        };
        let t = pieces.as_ref().map_or(schedule.t0, |pieces: &AssemblyPieces<'_>| pieces.time(made));
        Self { assembly, schedule, info, limits, pieces, meter, state, made, seconds, t, failure, ended: false }
    }

    pub(super) fn failed(&self) -> bool {
        self.failure.is_some()
    }

    /// Whether nothing is left to be done.
    pub(super) fn is_over(&self) -> bool {
        self.failure.is_some() || self.ended || self.made == self.schedule.steps
    }

    /// Makes steps up to number `to`, as far as the ticker, a failure or what looks on lets it come.
    pub(super) fn go(
        &mut self,
        to: u64,
        ticker: &mut AssemblyTicker<'_>,
        mut look: impl FnMut(&mut dyn AssemblyMethod, AssemblyStep<'_>) -> ControlFlow<LastNode>,
    ) {
        let Self { limits, pieces: Some(pieces), meter, state, made, seconds, t, .. } = self else {
            return;
        };
        let mut before = state.clone();
        while *made < to && !ticker.stopped {
            let (k, clock) = (*made, Instant::now());
            before.copy_from(state);
            let begins = pieces.begins(k);
            let PieceStep { assembly, stepper: method, time: (t0, h), end } = match pieces.step(k, state) {
                Ok(step) => step,
                Err(failure) => {
                    self.failure = Some(failure);
                    return;
                }
            };
            if begins {
                meter.jumped(assembly, t0, &before, state);
                before.copy_from(state);
            }
            let whole = method.step(assembly, t0, h, state).and_then(|iterations| {
                // Only a step that may be divided is asked whether it resolves the motion.
                limits.map_or(Ok(()), |_| resolves(assembly, method, (t0, h), (&before, state)))?;
                Ok(iterations)
            });
            *seconds += clock.elapsed().as_secs_f64();
            let Parted { last, iterations, parts } = match (whole, *limits) {
                (Ok(iterations), _) => {
                    let step = AssemblyStep { k, t0, h, before: &before, after: state };
                    let last = match look(method, step) {
                        ControlFlow::Continue(()) => {
                            meter.over(assembly, (t0, &before), (end, state));
                            None
                        }
                        ControlFlow::Break((t, last)) => {
                            meter.over(assembly, (t0, &before), (t, &last));
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
                    let parted = in_parts(assembly, method, step, (state, meter), stops, &mut look);
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
                (*state, self.t, self.ended) = (last, t, true);
                meter.see(assembly, (*made, t), state, iterations, parts);
                return;
            }
            *t = end;
            meter.see(assembly, (*made, end), state, iterations, parts);
            ticker.stops(*made);
        }
    }

    /// What came of it.
    pub(super) fn assembled(mut self, stopped: bool) -> Assembled {
        let interrupted = stopped && !self.is_over();
        let assembly = self.pieces.as_ref().map_or(self.assembly, AssemblyPieces::assembly);
        self.meter.finish(assembly, (self.made, self.t), &self.state);
        let cost = (self.t, self.made, self.seconds);
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
        let pieces = AssemblyPieces::new(assembly, method, schedule);
        let t = pieces.as_ref().map_or(schedule.t0, |pieces| pieces.time(made));
        let meter = AssemblyMeter::load(checkpoint, method, (made, t), nodes)?;
        Ok(Self::of((assembly, pieces), method, schedule, (meter, state, made, seconds)))
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
