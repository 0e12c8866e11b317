use super::Summary;
use crate::Method;
use crate::run::integrate_pieces;
use dla::{Ensemble, Mechanics, Observer, RunError, Schedule, State, StepReport, Subject, View};
use std::fmt::{Debug, Formatter};
use std::ops::ControlFlow;

/// `K` quantities of a configuration, angles with their full turns, and a velocity.
type Quantities<'a, const N: usize, const K: usize> = &'a dyn Fn(&[f64; N], &[f64; N]) -> [f64; K];

/// Which quantities are observed, and at which nodes.
#[derive(Clone, Copy)]
pub struct Watching<'a, const N: usize, const K: usize> {
    /// The steps.
    pub schedule: Schedule,
    /// Every so many of them, and at the end.
    pub every: u64,
    /// The quantities.
    pub of: Quantities<'a, N, K>,
}

impl<const N: usize, const K: usize> Debug for Watching<'_, N, K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { schedule, every, .. } = self;
        f.debug_struct("Watching").field("schedule", schedule).field("every", every).finish_non_exhaustive()
    }
}

/// The summaries of trajectories in lanes; none of one that was lost, which [`summarise`] tells more about.
pub fn watch<const N: usize, const M: usize, const W: usize, const K: usize>(
    ensemble: &mut dyn Ensemble<N, W>,
    systems: &[&dyn Mechanics<N, M>; W],
    watching: &Watching<'_, N, K>,
) -> Vec<Option<Summary<K>>> {
    let Watching { schedule, every, of } = watching;
    let mut summaries = vec![Some(Summary::new()); W];
    let mut made = 0;
    loop {
        let (state, t) = (ensemble.state(), schedule.time(made));
        for (lane, place) in summaries.iter_mut().enumerate() {
            let system = systems[lane];
            let known = place.as_mut().filter(|_| state.is_finite(lane));
            let seen = known.zip(system.velocity_of(t, &state.q(lane), &state.xi(lane)).ok());
            match seen {
                Some((summary, v)) => summary.see(system, t, &state.lane(lane, v), of),
                None => *place = None,
            }
        }
        if made >= schedule.steps {
            return summaries;
        }
        let steps = (*every).max(1).min(schedule.steps - made);
        ensemble.advance(steps);
        made += steps;
    }
}

/// The summary of one trajectory by any method; of one that fails that of its valid part, with the failure.
pub fn summarise<'a, const N: usize, const M: usize, const K: usize>(
    subject: impl Into<Subject<'a, N, M>>,
    method: &Method,
    (q, v): ([f64; N], [f64; N]),
    watching: &Watching<'_, N, K>,
) -> (Summary<K>, Option<RunError>) {
    let mut looking = Looking { watching, seen: Summary::new(), last: None };
    let subject = subject.into();
    let mut state = State::new(q, v, subject.system.angles());
    let outcome = integrate_pieces(subject, method, &watching.schedule, &mut state, &mut looking);
    (looking.seen, outcome.err())
}

/// The observer of one trajectory.
struct Looking<'a, 'b, const N: usize, const K: usize> {
    watching: &'a Watching<'b, N, K>,
    seen: Summary<K>,
    last: Option<u64>,
}

impl<const N: usize, const K: usize> Looking<'_, '_, N, K> {
    fn see<const M: usize>(&mut self, node: &View<'_, N, M>) {
        if self.last != Some(node.k) {
            self.last = Some(node.k);
            self.seen.see(node.system, node.t, node.state, self.watching.of);
        }
    }
}

impl<const N: usize, const M: usize, const K: usize> Observer<N, M> for Looking<'_, '_, N, K> {
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
