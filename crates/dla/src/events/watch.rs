use super::zeros::in_order;
use super::{Crossing, Event, Zero, zeros};
use crate::{Observer, OneStep, State, StepError, StepReport, Undivided, View};
use std::ops::ControlFlow;

/// The observer that looks for events, and shows another observer the run up to the first that ends it.
///
/// Inside a step the state is that of a shorter step of the same method from the same node, made with copies: the nodes of
/// the run are not touched, the state holds the constraint as a node does, and an event has the order of the method. A
/// method that remembers more than the state is repeated as in its first step.
///
/// Each step is looked at in [`samples`](Self::samples) parts, and a part beyond both of its ends, which costs so many steps
/// more, and one. No crossing is missed while between neighbouring samples each function is monotone, or has one
/// extremum and falls there to zero by no more than eight times what the parabola through the samples does; in
/// particular not two crossings within a step. Three crossings between two samples count as one.
///
/// An event that ends the run shows the inner observer a last node, by a step that is shortened to end there. The state
/// of the run itself is then one node further; [`ended`](Self::ended) has the one at the event.
#[derive(Debug)]
pub struct Watch<'a, Method, Inner, const N: usize> {
    /// Into how many parts a step is divided; 4 unless set, at least 1.
    pub samples: u32,
    /// To which interval of time a crossing is located (s); 0 unless set, which is to rounding.
    pub tolerance: f64,
    method: Method,
    events: &'a [Event<'a, N>],
    inner: Inner,
    before: Option<(f64, State<N>)>,
    /// Whether the parts of the step have been looked at already.
    in_parts: bool,
    crossings: Vec<Crossing<N>>,
    /// With the number of the node that it makes.
    ended: Option<(Crossing<N>, u64)>,
}

/// A step, to be made again in parts.
struct Again<'a, Sys, Method, const N: usize> {
    system: &'a Sys,
    method: &'a Method,
    t0: f64,
    h: f64,
    start: &'a State<N>,
    end: &'a State<N>,
}

impl<Sys, Method, const N: usize> Again<'_, Sys, Method, N> {
    fn time(&self, part: f64) -> f64 {
        self.t0 + part * self.h
    }

    /// The state after a part of the step, and what that step reported; none where it has no solution.
    fn after<const M: usize>(&self, part: f64) -> Option<(State<N>, StepReport<M>)>
    where
        Method: OneStep<Sys, N, M> + Clone,
    {
        let mut state = *self.start;
        let report = self.method.clone().step(self.system, self.t0, part * self.h, &mut state).ok()?;
        Some((state, report))
    }

    fn state<const M: usize>(&self, part: f64) -> Option<State<N>>
    where
        Method: OneStep<Sys, N, M> + Clone,
    {
        match part {
            0.0 => Some(*self.start),
            1.0 => Some(*self.end),
            _ => self.after(part).map(|(state, _)| state),
        }
    }
}

impl<'a, Method, Inner, const N: usize> Watch<'a, Method, Inner, N> {
    /// Watches a run made with `method`, and shows it to `inner`.
    pub fn new(method: Method, events: &'a [Event<'a, N>], inner: Inner) -> Self {
        let (crossings, before, ended) = (Vec::new(), None, None);
        Self { samples: 4, tolerance: 0.0, method, events, inner, before, in_parts: false, crossings, ended }
    }

    /// What happened, in the order in which it did.
    #[must_use]
    pub fn crossings(&self) -> &[Crossing<N>] {
        &self.crossings
    }

    /// The event that ended the run.
    #[must_use]
    pub fn ended(&self) -> Option<&Crossing<N>> {
        self.ended.as_ref().map(|(crossing, _)| crossing)
    }

    /// The inner observer.
    pub fn into_inner(self) -> Inner {
        self.inner
    }

    /// The crossings within a step from node `k`, in the order of time.
    fn within<Sys, const M: usize>(&self, step: &Again<'_, Sys, Method, N>, k: u64) -> Vec<Crossing<N>>
    where
        Method: OneStep<Sys, N, M> + Clone,
    {
        if self.events.is_empty() {
            return Vec::new();
        }
        let parts = i64::from(self.samples.max(1));
        let states: Vec<_> = (-1..=parts + 1)
            .filter_map(|j| {
                let at = j as f64 / parts as f64;
                step.state(at).map(|state| (at, state))
            })
            .collect();
        let mut found = Vec::new();
        for (index, event) in self.events.iter().enumerate() {
            let value = |at: f64| step.state(at).map_or(f64::NAN, |state| event.value(step.time(at), &state));
            let known: Vec<_> = states.iter().map(|(at, state)| (*at, event.value(step.time(*at), state))).collect();
            let tolerance = self.tolerance / step.h.abs();
            for Zero { at, within, rising } in zeros(&known, tolerance, |rising| event.counts(rising), value) {
                let Some(state) = step.state(at) else { continue };
                let within = within * step.h.abs();
                found.push((at, Crossing { event: index, k, t: step.time(at), within, rising, state }));
            }
        }
        in_order(found).collect()
    }

    /// Looks for crossings on the way to a node; `Break` where one of them has ended the run.
    fn look<Sys, const M: usize>(&mut self, node: &View<'_, Sys, N>, report: &StepReport<M>) -> ControlFlow<()>
    where
        Method: OneStep<Sys, N, M> + Clone,
        Inner: Observer<Sys, N, M>,
    {
        if self.ended.is_some() {
            return ControlFlow::Break(());
        }
        if let Some((t0, start)) = self.before {
            let method = self.method.clone();
            let step =
                Again { system: node.system, method: &method, t0, h: node.t - t0, start: &start, end: node.state };
            for crossing in self.within(&step, node.k.saturating_sub(1)) {
                if self.note(crossing, node.k) {
                    let report = step.after((crossing.t - t0) / step.h).map_or(*report, |(_, report)| report);
                    let last = View { system: node.system, k: node.k, t: crossing.t, state: &crossing.state };
                    // The run ends here, whatever the inner observer says.
                    let _ = self.inner.step(&last, &report);
                    return ControlFlow::Break(());
                }
            }
        }
        self.before = Some((node.t, *node.state));
        ControlFlow::Continue(())
    }

    /// Notes a crossing; whether it ends the run, there at node `k`.
    fn note(&mut self, crossing: Crossing<N>, k: u64) -> bool {
        self.crossings.push(crossing);
        let ends = self.events[crossing.event].terminal;
        if ends {
            self.ended = Some((crossing, k));
        }
        ends
    }
}

impl<Sys, Method, Inner, const N: usize, const M: usize> Observer<Sys, N, M> for Watch<'_, Method, Inner, N>
where
    Method: OneStep<Sys, N, M> + Clone,
    Inner: Observer<Sys, N, M>,
{
    fn start(&mut self, node: &View<'_, Sys, N>) {
        self.before = Some((node.t, *node.state));
        self.inner.start(node);
    }

    /// Where the velocity jumps, a function may jump over zero.
    fn resume(&mut self, node: &View<'_, Sys, N>) {
        if let Some((t, before)) = self.before {
            for (index, event) in self.events.iter().enumerate() {
                let (old, new) = (event.value(t, &before), event.value(node.t, node.state));
                let rising = old < 0.0;
                if old * new.signum() < 0.0 && new != 0.0 && event.counts(rising) && self.ended.is_none() {
                    let (k, t, state) = (node.k, node.t, *node.state);
                    self.note(Crossing { event: index, k, t, within: 0.0, rising, state }, k);
                }
            }
        }
        self.before = Some((node.t, *node.state));
        self.inner.resume(node);
    }

    fn step(&mut self, node: &View<'_, Sys, N>, report: &StepReport<M>) -> ControlFlow<()> {
        if !std::mem::take(&mut self.in_parts) {
            self.look(node, report)?;
        }
        self.inner.step(node, report)
    }

    /// Each part is looked at as a step is: a divided step may hold many crossings.
    fn part(&mut self, end: &View<'_, Sys, N>, report: &StepReport<M>) -> ControlFlow<()> {
        self.look(end, report)?;
        self.in_parts = true;
        self.inner.part(end, report)
    }

    fn undivided(&mut self, why: &Undivided<StepError>) {
        self.inner.undivided(why);
    }

    fn end(&mut self, node: &View<'_, Sys, N>) {
        match &self.ended {
            Some((Crossing { t, state, .. }, k)) => {
                self.inner.end(&View { system: node.system, k: *k, t: *t, state });
            }
            None => self.inner.end(node),
        }
    }
}
