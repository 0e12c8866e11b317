use super::integrator::Bound;
use crate::{
    AnyState, Hint, Integrator, Mechanics, Mechanism, OneStep, Report, State, StepError, Stop, Subject, Undivided,
};
use lagrangian::Shown;
use std::ops::{ControlFlow, Range};
use thiserror::Error;

/// The times of the steps of a run: node `k` is at `t0 + k h`, so that no rounding error adds up in the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Time of the first node (s).
    pub t0: f64,
    /// Step `h` (s); negative runs backward.
    pub step: f64,
    /// Number of steps.
    pub steps: u64,
}

impl Schedule {
    /// Time of node `k` (s).
    #[must_use]
    #[inline(always)]
    pub fn time(&self, k: u64) -> f64 {
        self.t0 + k as f64 * self.step
    }

    /// The time in the middle of some steps.
    #[must_use]
    pub fn middle(&self, steps: &Range<u64>) -> f64 {
        0.5 * (self.time(steps.start) + self.time(steps.end))
    }
}

/// A node of a run, as an observer sees it.
#[derive(Debug)]
pub struct View<'a> {
    /// The system.
    pub system: &'a dyn Mechanism,
    /// The number of steps made so far.
    pub k: u64,
    /// The time (s).
    pub t: f64,
    /// The state.
    pub state: &'a AnyState,
}

impl View<'_> {
    /// The energy `v . L_v - L` (J).
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.system.energy(self.t, self.state.q(), self.state.v())
    }

    /// The largest constraint residual `|A(q) v + b|`.
    #[must_use]
    pub fn constraint(&self) -> f64 {
        self.system.largest_residual(self.t, self.state.q(), self.state.v())
    }

    /// The largest of the functions of the constraints on positions; `None` if there are none.
    #[must_use]
    pub fn position(&self) -> Option<f64> {
        self.system.largest_position(self.t, self.state)
    }

    /// Keeps the time and the state as the node before the next one; without an allocation if there is one of the same system.
    pub fn keep_in(&self, before: &mut Option<(f64, AnyState)>) {
        match before {
            Some((t, state)) => {
                *t = self.t;
                state.clone_from(self.state);
            }
            None => *before = Some((self.t, self.state.clone())),
        }
    }
}

/// Something that looks at the nodes of a run and changes nothing.
///
/// `()` looks at nothing; a pair is two observers.
pub trait Observer {
    /// Sees the first node.
    fn start(&mut self, node: &View<'_>);

    /// Sees a node again at the beginning of the next smooth piece of a run: the velocity may have jumped.
    #[inline(always)]
    fn resume(&mut self, _node: &View<'_>) {}

    /// Sees a node after a step; `Break` ends the run there.
    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()>;

    /// Sees the end of each part of a divided step, with the number of the next node; the last part ends at the node that
    /// [`step`](Self::step) is shown after it. `Break` gives the step up and ends the run at the node before.
    fn part(&mut self, _end: &View<'_>, _report: &Report) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Whether it wants the [work](Report::work) of steps; methods measure it only on request.
    fn measures_work(&self) -> bool {
        false
    }

    /// Sees why a step cannot be made in parts either, before the run ends with that failure.
    fn undivided(&mut self, _why: &Undivided<StepError>) {}

    /// Sees the last good node once more when the run ends, by itself, by a `Break` or by a failure.
    #[inline(always)]
    fn end(&mut self, _node: &View<'_>) {}
}

impl Observer for () {
    #[inline(always)]
    fn start(&mut self, _node: &View<'_>) {}
    #[inline(always)]
    fn step(&mut self, _node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<A: Observer, B: Observer> Observer for (A, B) {
    #[inline(always)]
    fn start(&mut self, node: &View<'_>) {
        self.0.start(node);
        self.1.start(node);
    }
    #[inline(always)]
    fn resume(&mut self, node: &View<'_>) {
        self.0.resume(node);
        self.1.resume(node);
    }
    #[inline(always)]
    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        let first = self.0.step(node, report);
        let second = self.1.step(node, report);
        if first.is_break() { first } else { second }
    }
    fn part(&mut self, end: &View<'_>, report: &Report) -> ControlFlow<()> {
        let first = self.0.part(end, report);
        let second = self.1.part(end, report);
        if first.is_break() { first } else { second }
    }
    fn measures_work(&self) -> bool {
        self.0.measures_work() || self.1.measures_work()
    }
    fn undivided(&mut self, why: &Undivided<StepError>) {
        self.0.undivided(why);
        self.1.undivided(why);
    }
    #[inline(always)]
    fn end(&mut self, node: &View<'_>) {
        self.0.end(node);
        self.1.end(node);
    }
}

/// An observer that may be absent.
impl<O: Observer> Observer for Option<O> {
    fn start(&mut self, node: &View<'_>) {
        self.iter_mut().for_each(|observer| observer.start(node));
    }
    fn resume(&mut self, node: &View<'_>) {
        self.iter_mut().for_each(|observer| observer.resume(node));
    }
    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        self.as_mut().map_or(ControlFlow::Continue(()), |observer| observer.step(node, report))
    }
    fn part(&mut self, end: &View<'_>, report: &Report) -> ControlFlow<()> {
        self.as_mut().map_or(ControlFlow::Continue(()), |observer| observer.part(end, report))
    }
    fn measures_work(&self) -> bool {
        self.as_ref().is_some_and(Observer::measures_work)
    }
    fn undivided(&mut self, why: &Undivided<StepError>) {
        self.iter_mut().for_each(|observer| observer.undivided(why));
    }
    fn end(&mut self, node: &View<'_>) {
        self.iter_mut().for_each(|observer| observer.end(node));
    }
}

impl<O: Observer + ?Sized> Observer for &mut O {
    #[inline(always)]
    fn start(&mut self, node: &View<'_>) {
        (**self).start(node);
    }
    #[inline(always)]
    fn resume(&mut self, node: &View<'_>) {
        (**self).resume(node);
    }
    #[inline(always)]
    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        (**self).step(node, report)
    }
    fn part(&mut self, end: &View<'_>, report: &Report) -> ControlFlow<()> {
        (**self).part(end, report)
    }
    fn measures_work(&self) -> bool {
        (**self).measures_work()
    }
    fn undivided(&mut self, why: &Undivided<StepError>) {
        (**self).undivided(why);
    }
    #[inline(always)]
    fn end(&mut self, node: &View<'_>) {
        (**self).end(node);
    }
}

/// A run that ended early. Its observers keep what they saw; the state is at the last good node.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("step {step}, from t = {} s: {source}", Shown(*time))]
pub struct RunError {
    /// The number of the failed step, from 1.
    pub step: u64,
    /// The time at which it began, up to which the trajectory is valid (s).
    pub time: f64,
    /// The error of the step.
    #[source]
    pub source: StepError,
    /// The outcome of shorter steps from there.
    pub shorter: Shorter,
}

/// The outcome of steps that are shorter than one that failed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Shorter {
    /// None was tried.
    #[default]
    Untried,
    /// One of this part of the length succeeds.
    Succeeds(f64),
    /// They fail as well, down to this part of the length.
    Fails(f64),
}

impl RunError {
    /// The error of step number `step`, counted from one, which began at the time `time` (s).
    #[must_use]
    pub fn new(step: u64, time: f64, source: StepError) -> Self {
        Self { step, time, source, shorter: Shorter::Untried }
    }

    /// The same error with the outcome of shorter steps from the last good node, if the failure asks for a shorter step. The method is then
    /// as before.
    #[cold]
    #[must_use]
    pub fn with_shorter(self, method: &mut dyn Integrator, (h, state): (f64, &AnyState)) -> Self {
        /// Lengths that are tried, relative to the length that the failure asks for.
        const PARTS: [f64; 4] = [1.0, 0.25, 1.0 / 32.0, 1.0 / 512.0];
        let asked = match self.source {
            // The first two know the length; steps of a method's own are short already.
            StepError::Overshoot { .. } | StepError::Turn { .. } | StepError::Tolerance { .. } => None,
            source => source.hint(),
        };
        let Some(Hint::ShorterStep { part }) = asked else { return self };
        let remembered = method.memory();
        let succeeds = |x: &f64| {
            let mut copy = state.clone();
            method.recall(&[], &copy);
            method.step(self.time, x * part * h, &mut copy).is_ok()
        };
        let found = PARTS.into_iter().find(succeeds);
        method.recall(&remembered, state);
        let shorter = found.map_or(Shorter::Fails(PARTS[3] * part), |x| Shorter::Succeeds(x * part));
        Self { shorter, ..self }
    }
}

/// Makes the steps of a schedule with a method of the system's shape and shows every node to the observer; returns how many steps were made.
///
/// # Errors
/// [`RunError`] with the step that failed; `state` then is the last good node.
pub fn drive<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &mut dyn OneStep<N, M>,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: impl Observer,
) -> Result<u64, RunError> {
    drive_part(system, method, schedule, 0..schedule.steps, state, observer).map(|part| part.made)
}

/// As [`drive`] for some of the steps, and as [`make_steps`].
///
/// # Errors
/// As [`drive`].
pub fn drive_part<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &mut dyn OneStep<N, M>,
    schedule: &Schedule,
    steps: Range<u64>,
    state: &mut State<N>,
    mut observer: impl Observer,
) -> Result<Part, RunError> {
    let mut moved = AnyState::from(*state);
    let mut method = Bound::new(system, method);
    let part = make_steps(&Subject::driven(system), &mut method, schedule, steps, &mut moved, &mut observer);
    if let Some(moved) = moved.typed() {
        *state = *moved;
    }
    part
}

/// Some of the steps of a run, made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The number of steps made since the start of the run.
    pub made: u64,
    /// Whether the observer ended the run, or the caller ([`Stop`]).
    pub stopped: bool,
}

/// Makes the steps `steps.start + 1 ..= steps.end` of a schedule, as a part of a run: the observer sees the start with the first part, the
/// end with the last part or if the run ends early, and [`Observer::resume`] in between.
///
/// # Errors
/// [`RunError`] with the step that failed; `state` then is the last good node.
pub fn make_steps(
    system: &dyn Mechanism,
    method: &mut dyn Integrator,
    schedule: &Schedule,
    steps: Range<u64>,
    state: &mut AnyState,
    observer: &mut dyn Observer,
) -> Result<Part, RunError> {
    if observer.measures_work() {
        method.measure_work(system.power_sources());
    }
    steps_by(system, schedule, steps, state, observer, |k, state, observer| {
        let time = schedule.time(k);
        match method.step(time, schedule.step, state) {
            Ok(report) => {
                let node = View { system, k: k + 1, t: schedule.time(k + 1), state };
                Ok(Some(observer.step(&node, report)))
            }
            Err(StepError::Stopped) => Ok(None),
            Err(source) => {
                let source = system.explained((time, schedule.step), state, source);
                Err(RunError::new(k + 1, time, source))
            }
        }
    })
}

/// The loop over the steps of a part of a run: `step` makes the step from the node of the given number, and shows its end to the observer.
/// It gives `None`, with everything as it was, if the step is given up.
#[inline]
pub(super) fn steps_by(
    system: &dyn Mechanism,
    schedule: &Schedule,
    steps: Range<u64>,
    state: &mut AnyState,
    observer: &mut dyn Observer,
    mut step: impl FnMut(u64, &mut AnyState, &mut dyn Observer) -> Result<Option<ControlFlow<()>>, RunError>,
) -> Result<Part, RunError> {
    let mut made = steps.start;
    let first = View { system, k: made, t: schedule.time(made), state };
    if made == 0 {
        observer.start(&first);
    } else {
        observer.resume(&first);
    }
    let (mut outcome, mut stopped) = (Ok(()), false);
    let stop = Stop::of_thread_if_any();
    while made < steps.end && !stopped {
        if stop.as_ref().is_some_and(Stop::asked) {
            stopped = true;
            break;
        }
        match step(made, state, observer) {
            Ok(Some(flow)) => {
                made += 1;
                stopped = flow.is_break();
            }
            Ok(None) => stopped = true,
            Err(error) => {
                outcome = Err(error);
                break;
            }
        }
    }
    if stopped || outcome.is_err() || made == schedule.steps {
        observer.end(&View { system, k: made, t: schedule.time(made), state });
    }
    outcome.map(|()| Part { made, stopped })
}
