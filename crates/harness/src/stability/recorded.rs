use dla::{AnyState, Observer, Report, RunError, View, Work};
use std::fmt;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Number of values of a node that a case can look at.
pub const VALUES: usize = 6;

/// A node, as the checks see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Time (s).
    pub t: f64,
    /// The values that the case looks at; the rest is zero.
    pub values: [f64; VALUES],
    /// `|E - E0 - work|` (J).
    pub energy_error: f64,
    /// The constraint residual.
    pub constraint: f64,
}

/// A run, as the checks see it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recorded {
    /// The nodes, the start among them.
    pub nodes: Vec<Seen>,
    /// Why it ended early; `None` if it did not fail.
    pub failure: Option<RunError>,
    /// Whether it took longer than a case may.
    pub late: bool,
}

impl Recorded {
    /// The last node, unless the run ended before its time.
    #[must_use]
    pub fn end(&self) -> Option<&Seen> {
        if self.failure.is_some() || self.late { None } else { self.nodes.last() }
    }
}

/// The observer that records a run for the checks; it ends one that is no longer finite, or that takes too long.
pub struct Recorder<'a> {
    look: &'a dyn Fn(&AnyState) -> [f64; VALUES],
    every: u64,
    begun: Instant,
    initial: f64,
    work: Work,
    recorded: Recorded,
}

impl<'a> Recorder<'a> {
    /// No run of a case takes as long as this, on any machine and beside any other work.
    const LONGEST: Duration = Duration::from_secs(600);

    /// Keeps every `every`-th node, with what `look` sees in it.
    #[must_use]
    pub fn new(every: u64, look: &'a dyn Fn(&AnyState) -> [f64; VALUES]) -> Self {
        let (work, recorded) = (Work::default(), Recorded::default());
        Self { look, every: every.max(1), begun: Instant::now(), initial: 0.0, work, recorded }
    }

    /// The run, with why it ended early.
    #[must_use]
    pub fn recorded(self, failure: Option<RunError>) -> Recorded {
        Recorded { failure, ..self.recorded }
    }

    fn see(&mut self, node: &View<'_>) -> ControlFlow<()> {
        let late = node.k.is_multiple_of(1024) && self.begun.elapsed() > Self::LONGEST;
        self.recorded.late |= late;
        let mut broken = false;
        if node.k.is_multiple_of(self.every) {
            let values = (self.look)(node.state);
            let energy_error = (node.energy() - self.initial - self.work.total()).abs();
            self.recorded.nodes.push(Seen { t: node.t, values, energy_error, constraint: node.constraint() });
            broken = values.iter().any(|x| !x.is_finite());
        }
        if late || broken { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Observer for Recorder<'_> {
    fn start(&mut self, node: &View<'_>) {
        self.initial = node.energy();
        self.work.start(node);
        // A start that is not finite is seen again after the first step.
        let _ = self.see(node);
    }

    /// Also at the beginning of a run that has made steps before.
    fn resume(&mut self, node: &View<'_>) {
        if self.recorded.nodes.is_empty() {
            self.start(node);
        } else {
            self.work.resume(node);
        }
    }

    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        // Work never ends a run.
        let _ = self.work.step(node, report);
        self.see(node)
    }

    fn measures_work(&self) -> bool {
        true
    }
}

impl fmt::Debug for Recorder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder").field("every", &self.every).field("recorded", &self.recorded).finish_non_exhaustive()
    }
}
