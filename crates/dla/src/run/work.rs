use super::mechanism::Place;
use crate::{AnyState, Checkpoint, CheckpointError, Observer, Report, View};
use lagrangian::{PowerSources, two_sum};
use std::ops::ControlFlow;

/// The work done on a system since the start of a run (J), so that `E(t) - E(0) - work` is the error of the energy.
///
/// If a method reports the work of its step, that counts: a method of high order, or with steps of its own, integrates the
/// [power](crate::power()) at its own stages ([`OneStep::measure_work`](crate::OneStep::measure_work)). For other methods, up to order 6,
/// the power is integrated with four Gauss nodes along the polynomial of degree five that has the positions, velocities and accelerations
/// of both ends of the step, which is of order 6; if an end has no accelerations, along the polynomial of degree three. A system without
/// any power costs no acceleration, and a system that declares so ([`PowerSources`]) no evaluation. An impulse at a jump of an imposed
/// velocity does the work by which it changes the energy.
#[derive(Debug, Clone, PartialEq)]
pub struct Work {
    total: f64,
    rest: f64,
    before: Option<WorkNode>,
    /// The beginning of the last step whose work was asked for.
    start: Option<WorkNode>,
    /// The sum with its rest, and the node before, as they were at the last node, while a step is made in parts.
    at_node: Option<([f64; 2], Option<WorkNode>)>,
    /// The sources that may do work on the piece of the system.
    sources: PowerSources,
}

/// Time (s), configuration with its turns, and velocity of a node.
#[derive(Debug, Clone, PartialEq)]
struct WorkNode {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
}

impl WorkNode {
    fn of(t: f64, state: &AnyState) -> Self {
        Self { t, q: state.unwrapped(), v: state.v().to_vec() }
    }

    fn place(&self) -> Place<'_> {
        (self.t, &self.q, &self.v)
    }
}

impl Default for Work {
    fn default() -> Self {
        Self { total: 0.0, rest: 0.0, before: None, start: None, at_node: None, sources: PowerSources::ALL }
    }
}

impl Work {
    /// The work so far (J).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Adds with compensation.
    fn add(&mut self, work: f64) {
        (self.total, self.rest) = two_sum(self.total, work + self.rest);
    }

    /// Writes the work to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("work", &[self.total, self.rest]);
    }

    /// The work that [`save`](Self::save) wrote, to go on from the state of the same checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has none.
    pub fn load(checkpoint: &Checkpoint, t: f64, state: &AnyState) -> Result<Self, CheckpointError> {
        let [total, rest] = checkpoint.get("work")?;
        Ok(Self { total, rest, before: Some(WorkNode::of(t, state)), ..Self::default() })
    }

    fn remember(&mut self, node: &View<'_>) {
        match &mut self.before {
            Some(before) if before.v.len() == node.state.v().len() => {
                before.t = node.t;
                node.state.unwrap_into(&mut before.q);
                before.v.copy_from_slice(node.state.v());
            }
            before => *before = Some(WorkNode::of(node.t, node.state)),
        }
    }

    /// Adds the work over the step that ends at the node.
    fn over(&mut self, node: &View<'_>, report: &Report) {
        // If no method reports the work and a source may do some, the node before is needed beside this one.
        let asks = report.work.is_none() && self.sources.any();
        if asks {
            std::mem::swap(&mut self.before, &mut self.start);
        }
        self.remember(node);
        let ends = self.start.as_ref().zip(self.before.as_ref()).filter(|_| asks);
        let between = ends.map(|(from, to)| node.system.work_between(self.sources, from.place(), to.place()));
        if let Some(work) = report.work.or(between).filter(|work| *work != 0.0) {
            self.add(work);
        }
    }
}

impl Observer for Work {
    fn start(&mut self, node: &View<'_>) {
        self.sources = node.system.power_sources();
        self.remember(node);
    }

    #[allow(clippy::float_cmp, reason = "a velocity that has not jumped is the same to the bit")]
    fn resume(&mut self, node: &View<'_>) {
        if let Some(WorkNode { v, .. }) = &self.before
            && v != node.state.v()
        {
            let jump = node.energy() - node.system.energy(node.t, node.state.q(), v);
            self.add(jump);
        }
        self.sources = node.system.power_sources();
        self.remember(node);
    }

    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        // The parts of a divided step have led to this very node; but for an event, which ends it between two.
        let there = self.before.as_ref().is_some_and(|before| before.t.to_bits() == node.t.to_bits());
        if !(self.at_node.take().is_some() && there) {
            self.over(node, report);
        }
        ControlFlow::Continue(())
    }

    fn measures_work(&self) -> bool {
        true
    }

    fn part(&mut self, end: &View<'_>, report: &Report) -> ControlFlow<()> {
        if self.at_node.is_none() {
            self.at_node = Some(([self.total, self.rest], self.before.clone()));
        }
        self.over(end, report);
        ControlFlow::Continue(())
    }

    /// A step that was given up has done no work.
    fn end(&mut self, _node: &View<'_>) {
        if let Some(([total, rest], before)) = self.at_node.take() {
            (self.total, self.rest, self.before) = (total, rest, before);
        }
    }
}
