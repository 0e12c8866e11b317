use super::zeros::in_order;
use super::{Crossing, Event, Zero, zeros};
use crate::{Mechanics, OneStep, State, StepReport};

/// A step, or one of those that a method makes of its own within it, to be made again in parts.
pub(super) struct EventInterval<'a, Method, const N: usize, const M: usize> {
    pub(super) system: &'a dyn Mechanics<N, M>,
    pub(super) method: &'a Method,
    pub(super) t0: f64,
    pub(super) h: f64,
    pub(super) start: &'a State<N>,
    pub(super) end: &'a State<N>,
}

impl<Method, const N: usize, const M: usize> EventInterval<'_, Method, N, M>
where
    Method: OneStep<N, M> + Clone,
{
    fn time(&self, part: f64) -> f64 {
        self.t0 + part * self.h
    }

    /// The state after a part of the step, and what that step reported; none where it has no solution.
    pub(super) fn after(&self, part: f64) -> Option<(State<N>, StepReport<M>)> {
        let mut state = *self.start;
        let report = self.method.clone().step(self.system, self.t0, part * self.h, &mut state).ok()?;
        Some((state, report))
    }

    fn state(&self, part: f64) -> Option<State<N>> {
        match part {
            0.0 => Some(*self.start),
            1.0 => Some(*self.end),
            _ => self.after(part).map(|(state, _)| state),
        }
    }

    /// The crossings within it, in the order of time, looked for in so many parts and located to an interval of time (s). `k` is
    /// the node before.
    pub(super) fn crossings(
        &self,
        events: &[Event<'_, N>],
        (samples, tolerance): (u32, f64),
        k: u64,
    ) -> Vec<Crossing<N>> {
        let parts = i64::from(samples.max(1));
        let states: Vec<_> = (-1..=parts + 1)
            .filter_map(|j| {
                let at = j as f64 / parts as f64;
                self.state(at).map(|state| (at, state))
            })
            .collect();
        let (length, mut found) = (self.h.abs(), Vec::new());
        for (index, event) in events.iter().enumerate() {
            let value = |at: f64| self.state(at).map_or(f64::NAN, |state| event.value(self.time(at), &state));
            let known: Vec<_> = states.iter().map(|(at, state)| (*at, event.value(self.time(*at), state))).collect();
            for Zero { at, within, rising } in zeros(&known, tolerance / length, |rising| event.counts(rising), value) {
                let Some(state) = self.state(at) else { continue };
                let (t, within, spacing) = (self.time(at), within * length, length / parts as f64);
                found.push((at, Crossing { event: index, k, t, within, spacing, rising, state }));
            }
        }
        in_order(found).collect()
    }
}
