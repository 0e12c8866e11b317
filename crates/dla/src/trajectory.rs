use crate::{Observer, StepReport, View, Work};
use std::ops::ControlFlow;

/// A node that was kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node<const N: usize, const M: usize> {
    /// The number of steps made so far.
    pub k: u64,
    /// Time (s).
    pub t: f64,
    /// Configuration, angles with their full turns.
    pub q: [f64; N],
    /// Velocity.
    pub v: [f64; N],
    /// Energy (J).
    pub energy: f64,
    /// Work done since the start (J), so that `E(t) - E(0) - work` is the error of the energy.
    pub work: f64,
    /// Largest constraint residual `|A(q) v + b|`.
    pub constraint: f64,
    /// Constraint forces averaged over the step that led here; none at the start.
    pub multipliers: Option<[f64; M]>,
}

/// The observer that keeps the first node, every `every`-th and the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory<const N: usize, const M: usize> {
    nodes: Vec<Node<N, M>>,
    every: u64,
    time: f64,
    multipliers: Option<[f64; M]>,
    work: Work<N>,
}

impl<const N: usize, const M: usize> Trajectory<N, M> {
    /// Keeps every `every`-th node; 0 counts as 1.
    #[must_use]
    pub fn every(every: u64) -> Self {
        Self { nodes: Vec::new(), every: every.max(1), time: 0.0, multipliers: None, work: Work::default() }
    }

    /// The same for a run that goes on from a checkpoint, whose work [`Work::load`] gave: keeps the nodes after it.
    #[must_use]
    pub fn resumed(every: u64, t: f64, work: Work<N>) -> Self {
        Self { time: t, work, ..Self::every(every) }
    }

    /// The nodes kept, in the order of time.
    #[must_use]
    pub fn nodes(&self) -> &[Node<N, M>] {
        &self.nodes
    }

    fn keep(&mut self, view: &View<'_, N, M>) {
        self.nodes.push(Node {
            k: view.k,
            t: view.t,
            q: view.state.unwrapped(),
            v: *view.state.v(),
            energy: view.energy(),
            work: self.work.total(),
            constraint: view.constraint(),
            multipliers: self.multipliers,
        });
    }
}

impl<const N: usize, const M: usize> Observer<N, M> for Trajectory<N, M> {
    fn start(&mut self, node: &View<'_, N, M>) {
        (self.time, self.multipliers) = (node.t, None);
        self.work.start(node);
        self.keep(node);
    }

    fn resume(&mut self, node: &View<'_, N, M>) {
        self.work.resume(node);
    }

    fn step(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        // Work never ends a run.
        let _ = self.work.step(node, report);
        self.multipliers = Some(report.multipliers(node.t - self.time));
        self.time = node.t;
        if node.k.is_multiple_of(self.every) {
            self.keep(node);
        }
        ControlFlow::Continue(())
    }

    fn part(&mut self, end: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        self.work.part(end, report)
    }

    fn end(&mut self, node: &View<'_, N, M>) {
        self.work.end(node);
        if self.nodes.last().is_none_or(|last| last.k != node.k) {
            self.keep(node);
        }
    }
}
