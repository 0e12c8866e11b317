use dla::{Observer, StepReport, View};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Timed runs shorter than this in all are repeated.
const ENOUGH: Duration = Duration::from_millis(20);
/// So many times at most.
const REPEATS: usize = 15;

/// Something to tell how many steps have been made.
pub trait Progress {
    /// So many more steps are done.
    fn advance(&mut self, steps: u64);
}

impl Progress for () {
    fn advance(&mut self, _steps: u64) {}
}

impl<F: FnMut(u64)> Progress for F {
    fn advance(&mut self, steps: u64) {
        self(steps);
    }
}

/// The observer that tells a [`Progress`] every so many steps.
pub(crate) struct Ticker<'a> {
    pub(crate) progress: &'a mut dyn Progress,
    pub(crate) told: u64,
}

impl Ticker<'_> {
    const EVERY: u64 = 1 << 14;
}

impl<Sys, const N: usize, const M: usize> Observer<Sys, N, M> for Ticker<'_> {
    fn start(&mut self, _node: &View<'_, Sys, N>) {}

    #[inline]
    fn step(&mut self, node: &View<'_, Sys, N>, _report: &StepReport<M>) -> ControlFlow<()> {
        if node.k.is_multiple_of(Self::EVERY) {
            self.progress.advance(node.k - self.told);
            self.told = node.k;
        }
        ControlFlow::Continue(())
    }

    fn end(&mut self, node: &View<'_, Sys, N>) {
        self.progress.advance(node.k - self.told);
        self.told = node.k;
    }
}

/// The median time of `f` over repeated calls, of one call where that is long enough (s).
pub(crate) fn median_seconds(mut f: impl FnMut()) -> f64 {
    let mut times = Vec::with_capacity(REPEATS);
    let begin = Instant::now();
    while times.is_empty() || (times.len() < REPEATS && begin.elapsed() < ENOUGH) {
        let start = Instant::now();
        f();
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
