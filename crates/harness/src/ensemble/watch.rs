use super::summary::Of;
use super::{Quantities, Summary};
use crate::Method;
use crate::run::integrate_pieces;
use dla::{Mechanism, Observer, Report, RunError, Schedule, View};
use std::fmt::{Debug, Formatter};
use std::ops::ControlFlow;

/// Which quantities are observed, and at which nodes.
#[derive(Clone, Copy)]
pub struct Watching<'a, Q> {
    /// The steps.
    pub schedule: Schedule,
    /// Every so many of them, and at the end.
    pub every: u64,
    /// The quantities.
    pub of: Of<'a, Q>,
}

impl<Q> Debug for Watching<'_, Q> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { schedule, every, .. } = self;
        f.debug_struct("Watching").field("schedule", schedule).field("every", every).finish_non_exhaustive()
    }
}

/// The summary of one trajectory by any method; of one that fails that of its valid part, with the failure.
pub fn summarise<Q: Quantities>(
    system: &dyn Mechanism,
    method: &Method,
    (q, v): (&[f64], &[f64]),
    watching: &Watching<'_, Q>,
) -> (Option<Summary<Q>>, Option<RunError>) {
    let mut looking = Looking { watching, seen: None, last: None };
    let mut state = system.state(q, v);
    let outcome = integrate_pieces(system, method, &watching.schedule, &mut state, &mut looking);
    (looking.seen, outcome.err())
}

/// The observer of one trajectory.
struct Looking<'a, 'b, Q> {
    watching: &'a Watching<'b, Q>,
    seen: Option<Summary<Q>>,
    last: Option<u64>,
}

impl<Q: Quantities> Looking<'_, '_, Q> {
    fn see(&mut self, node: &View<'_>) {
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

impl<Q: Quantities> Observer for Looking<'_, '_, Q> {
    fn start(&mut self, node: &View<'_>) {
        self.see(node);
    }

    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        if node.k.is_multiple_of(self.watching.every.max(1)) {
            self.see(node);
        }
        ControlFlow::Continue(())
    }

    fn end(&mut self, node: &View<'_>) {
        self.see(node);
    }
}
