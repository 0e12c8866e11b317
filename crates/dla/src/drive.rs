use crate::dependent::named;
use crate::suspect::suspect_along;
use crate::{Hint, Mechanics, OneStep, State, StepError, StepReport, Stop, Undivided};
use lagrangian::Shown;
use lagrangian::linear::largest;
use std::ops::{ControlFlow, Range};
use thiserror::Error;

/// When the steps of a run are made: node `k` is at `t0 + k h`, so that no rounding error adds up in the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Time of the first node (s).
    pub t0: f64,
    /// Step `h` (s); negative runs backward.
    pub step: f64,
    /// How many steps.
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
pub struct View<'a, const N: usize, const M: usize> {
    /// The system.
    pub system: &'a dyn Mechanics<N, M>,
    /// The number of steps made so far.
    pub k: u64,
    /// The time (s).
    pub t: f64,
    /// The state.
    pub state: &'a State<N>,
}

impl<const N: usize, const M: usize> View<'_, N, M> {
    /// The energy `v . L_v - L` (J).
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.system.energy(self.t, self.state.q(), self.state.v())
    }

    /// The largest constraint residual `|A(q) v + b|`.
    #[must_use]
    pub fn constraint(&self) -> f64 {
        largest(&self.system.residual(self.t, self.state.q(), self.state.v()))
    }
}

/// Something that looks at the nodes of a run and changes nothing.
///
/// `()` looks at nothing; a pair is two observers.
pub trait Observer<const N: usize, const M: usize> {
    /// Sees the first node.
    fn start(&mut self, node: &View<'_, N, M>);

    /// Sees a node again where the next smooth piece of a run begins: the velocity may have jumped.
    #[inline(always)]
    fn resume(&mut self, _node: &View<'_, N, M>) {}

    /// Sees a node after a step; `Break` ends the run there.
    fn step(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()>;

    /// Sees where each part of a divided step ends, the last at the node that [`step`](Self::step) is shown after it, and that
    /// node's number; `Break` gives the step up and ends the run at the node before.
    fn part(&mut self, _end: &View<'_, N, M>, _report: &StepReport<M>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Whether it wants the [work](StepReport::work) of steps, which methods measure only for who does.
    fn measures_work(&self) -> bool {
        false
    }

    /// Sees why a step cannot be made in parts either, before the run ends with that failure.
    fn undivided(&mut self, _why: &Undivided<StepError>) {}

    /// Sees the last good node once more when the run ends, by itself, by a `Break` or by a failure.
    #[inline(always)]
    fn end(&mut self, _node: &View<'_, N, M>) {}
}

impl<const N: usize, const M: usize> Observer<N, M> for () {
    #[inline(always)]
    fn start(&mut self, _node: &View<'_, N, M>) {}
    #[inline(always)]
    fn step(&mut self, _node: &View<'_, N, M>, _report: &StepReport<M>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<A, B, const N: usize, const M: usize> Observer<N, M> for (A, B)
where
    A: Observer<N, M>,
    B: Observer<N, M>,
{
    #[inline(always)]
    fn start(&mut self, node: &View<'_, N, M>) {
        self.0.start(node);
        self.1.start(node);
    }
    #[inline(always)]
    fn resume(&mut self, node: &View<'_, N, M>) {
        self.0.resume(node);
        self.1.resume(node);
    }
    #[inline(always)]
    fn step(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        let first = self.0.step(node, report);
        let second = self.1.step(node, report);
        if first.is_break() { first } else { second }
    }
    fn part(&mut self, end: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
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
    fn end(&mut self, node: &View<'_, N, M>) {
        self.0.end(node);
        self.1.end(node);
    }
}

/// Looks where there is something to look with.
impl<O: Observer<N, M>, const N: usize, const M: usize> Observer<N, M> for Option<O> {
    fn start(&mut self, node: &View<'_, N, M>) {
        self.iter_mut().for_each(|observer| observer.start(node));
    }
    fn resume(&mut self, node: &View<'_, N, M>) {
        self.iter_mut().for_each(|observer| observer.resume(node));
    }
    fn step(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        self.as_mut().map_or(ControlFlow::Continue(()), |observer| observer.step(node, report))
    }
    fn part(&mut self, end: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        self.as_mut().map_or(ControlFlow::Continue(()), |observer| observer.part(end, report))
    }
    fn measures_work(&self) -> bool {
        self.as_ref().is_some_and(Observer::measures_work)
    }
    fn undivided(&mut self, why: &Undivided<StepError>) {
        self.iter_mut().for_each(|observer| observer.undivided(why));
    }
    fn end(&mut self, node: &View<'_, N, M>) {
        self.iter_mut().for_each(|observer| observer.end(node));
    }
}

impl<O: Observer<N, M> + ?Sized, const N: usize, const M: usize> Observer<N, M> for &mut O {
    #[inline(always)]
    fn start(&mut self, node: &View<'_, N, M>) {
        (**self).start(node);
    }
    #[inline(always)]
    fn resume(&mut self, node: &View<'_, N, M>) {
        (**self).resume(node);
    }
    #[inline(always)]
    fn step(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        (**self).step(node, report)
    }
    fn part(&mut self, end: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        (**self).part(end, report)
    }
    fn measures_work(&self) -> bool {
        (**self).measures_work()
    }
    fn undivided(&mut self, why: &Undivided<StepError>) {
        (**self).undivided(why);
    }
    #[inline(always)]
    fn end(&mut self, node: &View<'_, N, M>) {
        (**self).end(node);
    }
}

/// A run that ended early. Its observers keep what they saw, the state is that of the last good node.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("step {step}, from t = {} s: {source}", Shown(*time))]
pub struct RunError {
    /// The number of the failed step, from 1.
    pub step: u64,
    /// The time it began at, which is how far the trajectory is valid (s).
    pub time: f64,
    /// What happened.
    #[source]
    pub source: StepError,
    /// What is known of shorter steps from there.
    pub shorter: Shorter,
}

/// What is known of steps that are shorter than one that failed.
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
    /// A run that failed with its step of that number, from one, which began at that time (s).
    #[must_use]
    pub fn new(step: u64, time: f64, source: StepError) -> Self {
        Self { step, time, source, shorter: Shorter::Untried }
    }

    /// The same with what shorter steps do, where the failure asks for one: those from the last good node are tried. The method is then as
    /// before.
    #[cold]
    #[must_use]
    pub fn with_shorter<const N: usize, const M: usize>(
        self,
        system: &dyn Mechanics<N, M>,
        method: &mut dyn OneStep<N, M>,
        (h, state): (f64, &State<N>),
    ) -> Self {
        /// So much shorter than the failure asks for.
        const PARTS: [f64; 4] = [1.0, 0.25, 1.0 / 32.0, 1.0 / 512.0];
        let asked = match self.source {
            // The first two know it; steps of a method's own are short already.
            StepError::Overshoot { .. } | StepError::Turn { .. } | StepError::Tolerance { .. } => None,
            source => source.hint(),
        };
        let Some(Hint::ShorterStep { part }) = asked else { return self };
        let remembered = method.memory();
        let succeeds = |x: &f64| {
            let mut copy = *state;
            method.recall(&[], &copy);
            method.step(system, self.time, x * part * h, &mut copy).is_ok()
        };
        let found = PARTS.into_iter().find(succeeds);
        method.recall(&remembered, state);
        let shorter = found.map_or(Shorter::Fails(PARTS[3] * part), |x| Shorter::Succeeds(x * part));
        Self { shorter, ..self }
    }
}

/// Makes the steps of a schedule and shows every node to the observer; returns how many steps were made.
///
/// # Errors
/// [`RunError`] with the step that failed; `state` then is the last good node.
#[inline]
pub fn drive<Method, Obs, const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &mut Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: Obs,
) -> Result<u64, RunError>
where
    Method: OneStep<N, M> + ?Sized,
    Obs: Observer<N, M>,
{
    drive_part(system, method, schedule, 0..schedule.steps, state, observer).map(|part| part.made)
}

/// Some of the steps of a run, made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The number of steps made since the start of the run.
    pub made: u64,
    /// Whether the observer ended the run, or whoever waits for it ([`Stop`]).
    pub stopped: bool,
}

/// Makes the steps `steps.start + 1 ..= steps.end` of a schedule, as a part of a run: the observer sees the start with the
/// first part, the end with the last or where the run ends early, and [`Observer::resume`] in between.
///
/// # Errors
/// As [`drive`].
// Not inlined: the loops of all methods would become one function, and slow to compile. A build for any x86-64 has a second one with the
// instructions of AVX2: the same bits, in .75 to .8 of the time.
#[cfg_attr(not(target_feature = "avx2"), multiversion::multiversion(targets("x86_64+avx2+bmi1+bmi2+lzcnt")))]
#[inline(never)]
pub fn drive_part<Method, Obs, const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &mut Method,
    schedule: &Schedule,
    steps: Range<u64>,
    state: &mut State<N>,
    mut observer: Obs,
) -> Result<Part, RunError>
where
    Method: OneStep<N, M> + ?Sized,
    Obs: Observer<N, M>,
{
    let mut made = steps.start;
    if observer.measures_work() {
        method.measure_work(system.power_sources());
    }
    let first = View { system, k: made, t: schedule.time(made), state };
    if made == 0 {
        observer.start(&first);
    } else {
        observer.resume(&first);
    }
    let (mut outcome, mut stopped) = (Ok(()), false);
    let stop = Stop::of_thread_if_any();
    while made < steps.end {
        if stop.as_ref().is_some_and(Stop::asked) {
            stopped = true;
            break;
        }
        // The time is computed again where a step fails, so that it need not be kept during the step.
        match method.step(system, schedule.time(made), schedule.step, state) {
            Ok(report) => {
                made += 1;
                let node = View { system, k: made, t: schedule.time(made), state };
                if observer.step(&node, &report).is_break() {
                    stopped = true;
                    break;
                }
            }
            Err(StepError::Stopped) => {
                stopped = true;
                break;
            }
            Err(source) => {
                let time = schedule.time(made);
                let source = suspect_along(system, (time, schedule.step), state, state.v(), source);
                let source = named(system, (time, schedule.step), state, source);
                outcome = Err(RunError::new(made + 1, time, source));
                break;
            }
        }
    }
    if stopped || outcome.is_err() || made == schedule.steps {
        observer.end(&View { system, k: made, t: schedule.time(made), state });
    }
    outcome.map(|()| Part { made, stopped })
}
