use super::summary::Of;
use super::{Quantities, Summary};
use crate::Method;
use crate::run::integrate_pieces;
use dla::{Observer, RunError, Schedule, State, StepReport, Subject, View};
use std::fmt::{Debug, Formatter};
use std::ops::ControlFlow;

/// Which quantities are observed, and at which nodes.
#[derive(Clone, Copy)]
pub struct Watching<'a, Q, const N: usize> {
    /// The steps.
    pub schedule: Schedule,
    /// Every so many of them, and at the end.
    pub every: u64,
    /// The quantities.
    pub of: Of<'a, Q, N>,
}

impl<Q, const N: usize> Debug for Watching<'_, Q, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { schedule, every, .. } = self;
        f.debug_struct("Watching").field("schedule", schedule).field("every", every).finish_non_exhaustive()
    }
}

/// The summary of one trajectory by any method; of one that fails that of its valid part, with the failure.
pub fn summarise<'a, Q: Quantities, const N: usize, const M: usize>(
    subject: impl Into<Subject<'a, N, M>>,
    method: &Method,
    (q, v): ([f64; N], [f64; N]),
    watching: &Watching<'_, Q, N>,
) -> (Option<Summary<Q>>, Option<RunError>) {
    let mut looking = Looking { watching, seen: None, last: None };
    let subject = subject.into();
    let mut state = State::new(q, v, subject.system.angles());
    let outcome = integrate_pieces(subject, method, &watching.schedule, &mut state, &mut looking);
    (looking.seen, outcome.err())
}

/// The observer of one trajectory.
struct Looking<'a, 'b, Q, const N: usize> {
    watching: &'a Watching<'b, Q, N>,
    seen: Option<Summary<Q>>,
    last: Option<u64>,
}

impl<Q: Quantities, const N: usize> Looking<'_, '_, Q, N> {
    fn see<const M: usize>(&mut self, node: &View<'_, N, M>) {
        if self.last == Some(node.k) {
            return;
        }
        self.last = Some(node.k);
        let of = self.watching.of;
        match &mut self.seen {
            Some(seen) => seen.see(node.system, node.t, node.state, of),
            None => self.seen = Some(Summary::first(node.system, node.t, node.state, of)),
        }
    }
}

impl<Q: Quantities, const N: usize, const M: usize> Observer<N, M> for Looking<'_, '_, Q, N> {
    fn start(&mut self, node: &View<'_, N, M>) {
        self.see(node);
    }

    fn step(&mut self, node: &View<'_, N, M>, _report: &StepReport<M>) -> ControlFlow<()> {
        if node.k.is_multiple_of(self.watching.every.max(1)) {
            self.see(node);
        }
        ControlFlow::Continue(())
    }

    fn end(&mut self, node: &View<'_, N, M>) {
        self.see(node);
    }
}
