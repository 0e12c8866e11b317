use super::substeps::Again;
use crate::{AnyState, Method, Observer, Report, StepError, View};
use std::ops::ControlFlow;

/// The observer that takes the state at given times, wherever the nodes are.
///
/// Between nodes the state comes from a shorter step of the same method from the node before, made with copies: it has the order of the
/// method and holds the constraint as a node does, and the nodes of the run are not touched. The velocity is the derivative of the position
/// to that order. At a node it is the node; if a velocity jumps there, the node before the jump. A method that remembers more than the
/// state repeats the step as its first one. [`Hermite`](crate::Hermite) is cheaper.
#[derive(Debug, Clone)]
pub struct Samples<'a> {
    method: &'a Method,
    times: &'a [f64],
    before: Option<(f64, AnyState)>,
    taken: Vec<AnyState>,
    failure: Option<StepError>,
}

impl<'a> Samples<'a> {
    /// Takes samples of a run with `method` at `times` (s), which are in the order in which the run goes.
    pub fn new(method: &'a Method, times: &'a [f64]) -> Self {
        Self { method, times, before: None, taken: Vec::with_capacity(times.len()), failure: None }
    }

    /// The states at the first of the times. They are fewer than the times if the run ended early, if the times are not in order or begin
    /// before the run, or if a step has [failed](Self::failure).
    #[must_use]
    pub fn taken(&self) -> &[AnyState] {
        &self.taken
    }

    /// Why a shorter step had no solution; nothing is taken after it.
    #[must_use]
    pub fn failure(&self) -> Option<StepError> {
        self.failure
    }

    /// The samples themselves.
    ///
    /// # Errors
    /// As [`failure`](Self::failure).
    pub fn into_taken(self) -> Result<Vec<AnyState>, StepError> {
        self.failure.map_or(Ok(self.taken), Err)
    }

    fn take(&mut self, node: &View<'_>, (t0, start): (f64, &AnyState)) {
        let (forward, mut shorter) = ((node.t - t0).signum(), None);
        while let Some(t) = self.times.get(self.taken.len()).copied()
            && self.failure.is_none()
        {
            let (since, left) = (forward * (t - t0), forward * (node.t - t));
            // A time that is not a number is never reached.
            if !(since >= 0.0 && left >= 0.0) {
                return;
            }
            let mut state = if left == 0.0 { node.state.clone() } else { start.clone() };
            if since > 0.0
                && left > 0.0
                && let Err(error) = shorter.get_or_insert_with(|| Again::new(node.system, self.method)).step(
                    (t0, t - t0),
                    &mut state,
                    false,
                )
            {
                self.failure = Some(error);
                return;
            }
            self.taken.push(state);
        }
    }
}

impl Observer for Samples<'_> {
    fn start(&mut self, node: &View<'_>) {
        node.keep_in(&mut self.before);
    }

    fn resume(&mut self, node: &View<'_>) {
        node.keep_in(&mut self.before);
    }

    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        if let Some((t0, start)) = self.before.take() {
            self.take(node, (t0, &start));
            self.before = Some((t0, start));
        }
        node.keep_in(&mut self.before);
        ControlFlow::Continue(())
    }

    /// A run without a step has its start.
    fn end(&mut self, node: &View<'_>) {
        while self.times.get(self.taken.len()) == Some(&node.t) && self.failure.is_none() {
            self.taken.push(node.state.clone());
        }
    }
}
