use super::interval::EventInterval;
use super::{Close, Crossing, Event, close_crossings};
use crate::run::substeps::Again;
use crate::{AnyState, Method, Observer, Report, StepError, Undivided, View};
use std::cell::RefCell;
use std::ops::ControlFlow;

/// A crossing within this number of roundings after the start of a run belongs to the start.
const AT_START: f64 = 64.0;

/// The observer that looks for events, and shows another observer the run up to the first that ends it.
///
/// Inside a step the state comes from a shorter step of the same method from the same node, made with copies: the nodes of the run are not
/// touched, the state holds the constraint as a node does, and an event has the order of the method. A method that remembers more than the
/// state repeats the step as its first one.
///
/// Each step is sampled in [`samples`](Self::samples) parts, and once beyond each of its ends, which costs `samples + 1` steps more. A
/// method with steps of its own within a step ([`OneStep::own_steps`](crate::OneStep::own_steps)) is sampled so in each of them, which costs one step more. No
/// crossing is missed while between neighbouring samples each function is monotone, or has one extremum and falls there to zero by no more
/// than eight times what the parabola through the samples does; in particular, two crossings within a step are found. If a function bends
/// more than that between samples, as a fast function of the time does, it is sampled in more parts, up to 2^14, on a cubic through the
/// states at the samples; its crossings are then located by steps as all others are. One value in each part is compared; a bend at none of
/// these places, as of a short pulse, is not seen. [`close`](Self::close) reports crossings so close that there may be others between them,
/// functions without a value at a sample, and functions that no number of parts shows.
///
/// A function that is zero at the start of a run, but for rounding, is not crossed there.
///
/// An event that ends the run shows the inner observer a last node, by a step that is shortened to end there. The state
/// of the run itself is then one node further; [`ended`](Self::ended) has the one at the event.
#[derive(Debug)]
pub struct Watch<'a, Inner> {
    /// Number of parts into which a step is divided; 4 unless set, at least 1.
    pub samples: u32,
    /// The interval of time to which a crossing is located (s); 0 unless set, which is to rounding.
    pub tolerance: f64,
    method: &'a Method,
    events: &'a [Event<'a>],
    inner: Inner,
    before: Option<(f64, AnyState)>,
    /// Whether no interval has been searched since the start of the run.
    at_start: bool,
    /// Number of times that an event was not seen as a whole in a step.
    incomplete: u64,
    /// The memory of the method's own steps; empty if it makes none.
    memory: Vec<f64>,
    /// Whether the parts of the step have been searched already.
    in_parts: bool,
    crossings: Vec<Crossing>,
    /// The crossing that ended the run, with the number of its node.
    ended: Option<(Crossing, u64)>,
}

impl<'a, Inner: Observer> Watch<'a, Inner> {
    /// Watches a run made with `method`, and shows it to `inner`.
    pub fn new(method: &'a Method, events: &'a [Event<'a>], inner: Inner) -> Self {
        Self {
            samples: 4,
            tolerance: 0.0,
            method,
            events,
            inner,
            before: None,
            at_start: false,
            incomplete: 0,
            memory: Vec::new(),
            in_parts: false,
            crossings: Vec::new(),
            ended: None,
        }
    }

    /// The same observer for a run that has come to this time (s) and state.
    #[must_use]
    pub fn resumed(self, t: f64, state: AnyState) -> Self {
        Self { before: Some((t, state)), ..self }
    }

    /// The crossings, in the order of time.
    #[must_use]
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// The event that ended the run.
    #[must_use]
    pub fn ended(&self) -> Option<&Crossing> {
        self.ended.as_ref().map(|(crossing, _)| crossing)
    }

    /// The inner observer.
    pub fn into_inner(self) -> Inner {
        self.inner
    }

    /// Why crossings may have been missed: crossings so close to one another that others may be between them (see [`close_crossings`]), and
    /// steps that were not [seen](Self::incomplete) as a whole.
    #[must_use]
    pub fn close(&self) -> Option<Close> {
        let looked = self.crossings.iter().map(|crossing| (crossing.event, crossing.t, crossing.spacing));
        Close::with_incomplete(close_crossings(looked, |event| self.events[event].leaves_some_out()), self.incomplete)
    }

    /// Number of times that an event was not seen as a whole in a step (see [`Close::incomplete`]).
    #[must_use]
    pub fn incomplete(&self) -> u64 {
        self.incomplete
    }

    /// Looks for events on the way to a node. If an event ends the run, shows the inner observer the last node, and returns `Break`.
    fn look(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        if self.ended.is_some() {
            return ControlFlow::Break(());
        }
        // No state is kept for nothing.
        if self.events.is_empty() {
            return ControlFlow::Continue(());
        }
        if let Some((t0, start)) = self.before.take() {
            self.look_within(node, (t0, &start));
            if let Some((crossing, _)) = &self.ended {
                let (again, h) = (RefCell::new(Again::new(node.system, self.method)), node.t - t0);
                let step = EventInterval { again, t0, h, start: &start, end: node.state };
                let ended = step.after((crossing.t - t0) / h, self.inner.measures_work()).map(|(_, report)| report);
                let last = View { system: node.system, k: node.k, t: crossing.t, state: &crossing.state };
                // The run ends here, whatever the inner observer says.
                let _ = self.inner.step(&last, ended.as_ref().unwrap_or(report));
                return ControlFlow::Break(());
            }
            self.before = Some((t0, start));
        }
        node.keep_in(&mut self.before);
        ControlFlow::Continue(())
    }

    /// Looks for events in each of the steps that the method makes of its own on the way to a node, until one ends the run.
    fn look_within(&mut self, node: &View<'_>, (t0, start): (f64, &AnyState)) {
        let mut from = (t0, start.clone());
        if self.method.is_adaptive() {
            let (integrator, mut memory) = (node.system.integrator(self.method), std::mem::take(&mut self.memory));
            let made = integrator.own_steps((t0, node.t - t0), start, &mut memory, &mut |t, state| {
                let (t0, before) = std::mem::replace(&mut from, (t, state.clone()));
                self.look_between(node, (t0, &before), (t, state))
            });
            // If the own steps cannot be made again, the rest is searched as one.
            self.incomplete += u64::from(made.is_err());
            self.memory = memory;
        }
        if self.ended.is_none() {
            let _ = self.look_between(node, (from.0, &from.1), (node.t, node.state));
        }
    }

    /// Looks for events between two states of a step to `node`.
    fn look_between(
        &mut self,
        node: &View<'_>,
        (t0, start): (f64, &AnyState),
        (t, end): (f64, &AnyState),
    ) -> ControlFlow<()> {
        let again = RefCell::new(Again::new(node.system, self.method));
        let interval = EventInterval { again, t0, h: t - t0, start, end };
        let (mut found, incomplete) =
            interval.crossings(self.events, (self.samples, self.tolerance), node.k.saturating_sub(1));
        self.incomplete += incomplete;
        if std::mem::take(&mut self.at_start) {
            let rounding = AT_START * f64::EPSILON * f64::max(t0.abs(), (t - t0).abs());
            found.retain(|crossing| (crossing.t - t0).abs() > rounding);
        }
        let ends = found.into_iter().any(|crossing| self.note(crossing, node.k));
        if ends { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Notes a crossing; returns whether it ends the run, at node `k`.
    fn note(&mut self, crossing: Crossing, k: u64) -> bool {
        if !self.events[crossing.event].admits(&crossing) {
            return false;
        }
        let ends = self.events[crossing.event].terminal;
        if ends {
            self.ended = Some((crossing.clone(), k));
        }
        self.crossings.push(crossing);
        ends
    }
}

impl<Inner: Observer> Observer for Watch<'_, Inner> {
    fn start(&mut self, node: &View<'_>) {
        node.keep_in(&mut self.before);
        self.at_start = true;
        self.memory.clear();
        self.inner.start(node);
    }

    /// If the velocity jumps, a function may jump over zero.
    fn resume(&mut self, node: &View<'_>) {
        if let Some((t, before)) = self.before.take() {
            for (index, event) in self.events.iter().enumerate() {
                let (old, new) = (event.value(t, &before), event.value(node.t, node.state));
                let rising = old < 0.0;
                if old * new.signum() < 0.0 && new != 0.0 && event.counts(rising) && self.ended.is_none() {
                    let (k, t, state) = (node.k, node.t, node.state.clone());
                    self.note(Crossing { event: index, k, t, within: 0.0, spacing: 0.0, rising, state }, k);
                }
            }
        }
        node.keep_in(&mut self.before);
        self.memory.clear();
        self.inner.resume(node);
    }

    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        if std::mem::take(&mut self.in_parts) {
            self.memory.clear();
        } else {
            self.look(node, report)?;
        }
        self.inner.step(node, report)
    }

    /// Each part is searched as a step is: a divided step may hold many crossings.
    fn part(&mut self, end: &View<'_>, report: &Report) -> ControlFlow<()> {
        // A part is made without the memory of the method.
        self.memory.clear();
        self.look(end, report)?;
        self.in_parts = true;
        self.inner.part(end, report)
    }

    fn measures_work(&self) -> bool {
        self.inner.measures_work()
    }

    fn undivided(&mut self, why: &Undivided<StepError>) {
        self.inner.undivided(why);
    }

    fn end(&mut self, node: &View<'_>) {
        match &self.ended {
            Some((Crossing { t, state, .. }, k)) => {
                self.inner.end(&View { system: node.system, k: *k, t: *t, state });
            }
            None => self.inner.end(node),
        }
    }
}
