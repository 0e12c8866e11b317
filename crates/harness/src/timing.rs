use crate::stopwatch::take;
use dla::{Observer, Report, View};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Timed runs shorter than this in all are repeated.
const ENOUGH: Duration = Duration::from_millis(20);
/// Maximum number of timed runs.
const REPEATS: usize = 15;

/// Receives the number of steps that have been made.
pub trait Progress {
    /// `steps` more steps are done.
    fn advance(&mut self, steps: u64);

    /// `steps` more steps will be made than were announced.
    fn expect(&mut self, _steps: u64) {}

    /// Whether the run is to end here, with what it has; asked every 2^10 steps, of a system of many coordinates more often, and after every
    /// part of a divided one.
    fn stops(&self) -> bool {
        false
    }
}

impl Progress for () {
    fn advance(&mut self, _steps: u64) {}
}

/// If there is one.
impl Progress for Option<&mut dyn Progress> {
    fn advance(&mut self, steps: u64) {
        self.iter_mut().for_each(|progress| progress.advance(steps));
    }

    fn expect(&mut self, steps: u64) {
        self.iter_mut().for_each(|progress| progress.expect(steps));
    }

    fn stops(&self) -> bool {
        self.as_ref().is_some_and(|progress| progress.stops())
    }
}

impl<F: FnMut(u64)> Progress for F {
    fn advance(&mut self, steps: u64) {
        self(steps);
    }
}

/// The observer that reports to a [`Progress`] every 2^10 steps.
pub(crate) struct Ticker<'a> {
    pub(crate) progress: &'a mut dyn Progress,
    pub(crate) told: u64,
    pub(crate) stopped: bool,
    every: u64,
}

impl<'a> Ticker<'a> {
    const EVERY: u64 = 1 << 10;
    /// Largest number of coordinates of a system whose steps take about the same time; beyond, the time grows with the number.
    const FEW: u64 = 64;

    /// Every how many steps of a system the progress is told.
    fn every(node: &View<'_>) -> u64 {
        (Self::EVERY / (node.system.size().n as u64).div_ceil(Self::FEW).next_power_of_two()).max(1)
    }

    /// The ticker of a run that has reported `told` steps already.
    pub(crate) fn new(progress: &'a mut dyn Progress, told: u64) -> Self {
        Self { progress, told, stopped: false, every: Self::EVERY }
    }
}

impl Observer for Ticker<'_> {
    fn start(&mut self, node: &View<'_>) {
        self.every = Self::every(node);
    }

    fn resume(&mut self, node: &View<'_>) {
        self.every = Self::every(node);
    }

    #[inline]
    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        // A power of two.
        if node.k & (self.every - 1) == 0 {
            self.progress.advance(node.k - self.told);
            self.told = node.k;
            if self.progress.stops() {
                self.stopped = true;
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }

    fn part(&mut self, _end: &View<'_>, _report: &Report) -> ControlFlow<()> {
        self.stopped = self.progress.stops();
        if self.stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn end(&mut self, node: &View<'_>) {
        self.progress.advance(node.k - self.told);
        self.told = node.k;
    }
}

/// The observer that only asks whether to go on.
pub(crate) struct Stopper<'a>(pub(crate) Option<&'a dyn Progress>);

impl Observer for Stopper<'_> {
    fn start(&mut self, _node: &View<'_>) {}

    #[inline]
    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        if node.k.is_multiple_of(Ticker::EVERY) && self.0.is_some_and(Progress::stops) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn part(&mut self, _end: &View<'_>, _report: &Report) -> ControlFlow<()> {
        if self.0.is_some_and(Progress::stops) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// The median time of `f` over repeated calls, or the time of one call if that is long enough (s): the processor's time of this thread, so
/// that other work of the machine is not in it; elapsed time if the system tells no other.
pub(crate) fn median_seconds(mut f: impl FnMut()) -> f64 {
    let mut times = Vec::with_capacity(REPEATS);
    let begin = Instant::now();
    while times.is_empty() || (times.len() < REPEATS && begin.elapsed() < ENOUGH) {
        times.push(take(1, &mut f).cpu);
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
