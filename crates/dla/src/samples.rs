use crate::{Observer, OneStep, State, StepError, StepReport, View};
use std::ops::ControlFlow;

/// The observer that takes the state at given times, wherever the nodes are.
///
/// Between nodes the state is that of a shorter step of the same method from the node before, made with copies: it has the
/// order of the method and holds the constraint as a node does, and the nodes of the run are not touched. The velocity is
/// the derivative of the position to that order. At a node it is the node; where a velocity jumps there, the one before.
/// A method that remembers more than the state is repeated as in its first step. [`Hermite`](crate::Hermite) is cheaper.
#[derive(Debug, Clone)]
pub struct Samples<'a, Method, const N: usize> {
    method: Method,
    times: &'a [f64],
    before: Option<(f64, State<N>)>,
    taken: Vec<State<N>>,
    failure: Option<StepError>,
}

impl<'a, Method, const N: usize> Samples<'a, Method, N> {
    /// Takes samples of a run with `method` at `times` (s), which are in the order in which the run goes.
    pub fn new(method: Method, times: &'a [f64]) -> Self {
        Self { method, times, before: None, taken: Vec::with_capacity(times.len()), failure: None }
    }

    /// The states at the first of the times; fewer than those where the run ended early, where the times are not in
    /// order or begin before the run, or where a step has [failed](Self::failure).
    #[must_use]
    pub fn taken(&self) -> &[State<N>] {
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
    pub fn into_taken(self) -> Result<Vec<State<N>>, StepError> {
        self.failure.map_or(Ok(self.taken), Err)
    }

    fn take<const M: usize>(&mut self, node: &View<'_, N, M>, (t0, start): (f64, State<N>))
    where
        Method: OneStep<N, M> + Clone,
    {
        let forward = (node.t - t0).signum();
        while let Some(t) = self.times.get(self.taken.len()).copied()
            && self.failure.is_none()
        {
            let (since, left) = (forward * (t - t0), forward * (node.t - t));
            // What is not a number is never reached.
            if !(since >= 0.0 && left >= 0.0) {
                return;
            }
            let mut state = if left == 0.0 { *node.state } else { start };
            if since > 0.0
                && left > 0.0
                && let Err(error) = self.method.clone().step(node.system, t0, t - t0, &mut state)
            {
                self.failure = Some(error);
                return;
            }
            self.taken.push(state);
        }
    }
}

impl<Method, const N: usize, const M: usize> Observer<N, M> for Samples<'_, Method, N>
where
    Method: OneStep<N, M> + Clone,
{
    fn start(&mut self, node: &View<'_, N, M>) {
        self.before = Some((node.t, *node.state));
    }

    fn resume(&mut self, node: &View<'_, N, M>) {
        self.start(node);
    }

    fn step(&mut self, node: &View<'_, N, M>, _report: &StepReport<M>) -> ControlFlow<()> {
        if let Some(before) = self.before {
            self.take(node, before);
        }
        self.before = Some((node.t, *node.state));
        ControlFlow::Continue(())
    }

    /// A run without a step has its start.
    fn end(&mut self, node: &View<'_, N, M>) {
        while self.times.get(self.taken.len()) == Some(&node.t) && self.failure.is_none() {
            self.taken.push(*node.state);
        }
    }
}
