use super::finer::Between;
use super::zeros::{Zeros, in_order, zeros_by};
use super::{Crossing, Event, Zero};
use crate::run::substeps::Again;
use crate::{AnyState, Report};
use std::cell::RefCell;

/// A step, or one that a method makes of its own within it, to be made again in parts.
pub(super) struct EventInterval<'a> {
    pub(super) again: RefCell<Again<'a>>,
    pub(super) t0: f64,
    pub(super) h: f64,
    pub(super) start: &'a AnyState,
    pub(super) end: &'a AnyState,
}

impl EventInterval<'_> {
    pub(super) fn time(&self, part: f64) -> f64 {
        self.t0 + part * self.h
    }

    /// The state after a part of the step, and the report of the step to there, with its work if `work` is set; `None` if that step has no
    /// solution.
    pub(super) fn after(&self, part: f64, work: bool) -> Option<(AnyState, Report)> {
        let mut state = self.start.clone();
        let report = self.again.borrow_mut().step((self.t0, part * self.h), &mut state, work).ok()?;
        Some((state, report))
    }

    pub(super) fn state(&self, part: f64) -> Option<AnyState> {
        match part {
            0.0 => Some(self.start.clone()),
            1.0 => Some(self.end.clone()),
            _ => self.after(part, false).map(|(state, _)| state),
        }
    }

    /// The crossings within it in the order of time, and the number of events that were not seen as a whole. An event is sampled in
    /// `samples` parts, or in more if it bends between them, and located to `tolerance` (s). `k` is the node before.
    pub(super) fn crossings(
        &self,
        events: &[Event<'_>],
        (samples, tolerance): (u32, f64),
        k: u64,
    ) -> (Vec<Crossing>, u64) {
        let parts = samples.max(1);
        let at = |j: i64| j as f64 / f64::from(parts);
        let states: Vec<_> = (-1..=i64::from(parts) + 1).map(|j| (at(j), self.state(at(j)))).collect();
        let (length, mut found, mut incomplete) = (self.h.abs(), Vec::new(), 0);
        for (index, event) in events.iter().enumerate() {
            let value = |at: f64| self.state(at).map_or(f64::NAN, |state| event.value(self.time(at), &state));
            let at_sample = |(at, state): &(f64, Option<AnyState>)| {
                (*at, state.as_ref().map_or(f64::NAN, |state| event.value(self.time(*at), state)))
            };
            let known: Vec<_> = states.iter().map(at_sample).collect();
            let between = self.between(event, &states, &known, parts);
            let untold = matches!(between, Between::Untold);
            let counts = |rising| event.counts(rising);
            let tolerance = tolerance / length;
            let search = |known: &[(f64, f64)], exact| zeros_by(known, exact, tolerance, counts, value);
            let (parts, Zeros { zeros, incomplete: missing }) = match between {
                Between::Finer(finer, values) => (finer, search(&values, false).or(|| search(&known, true))),
                Between::Told | Between::Untold => (parts, search(&known, true)),
            };
            incomplete += u64::from(missing || untold);
            for Zero { at, within, rising } in zeros {
                let Some(state) = self.state(at) else { continue };
                let (t, within, spacing) = (self.time(at), within * length, length / f64::from(parts));
                found.push((at, Crossing { event: index, k, t, within, spacing, rising, state }));
            }
        }
        (in_order(found).collect(), incomplete)
    }
}
