use crate::Method;
use crate::run::integrate_pieces;
use dla::{Mechanism, Observer, Report, RunError, Schedule, View};
use lagrangian::linear::larger;
use std::ops::ControlFlow;

/// A trajectory in a few numbers: its end, and extremes over the observed nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Time of the end (s).
    pub t: f64,
    /// The quantities at the end.
    pub end: Vec<f64>,
    /// The least of each.
    pub low: Vec<f64>,
    /// The largest of each.
    pub high: Vec<f64>,
    /// Energy at the start and at the end (J).
    pub energy: [f64; 2],
    /// `max |E - E0|` (J): an error, if nothing does work.
    pub energy_deviation: f64,
    /// `max |A(q) v + b|`.
    pub constraint: f64,
}

/// Quantities of a time (s), a configuration, angles with their full turns, and a velocity.
type Of<'a> = &'a dyn Fn(f64, &[f64], &[f64]) -> Vec<f64>;

/// The summary of one trajectory by any method, over every `every`-th of its nodes and the last. If it fails, the summary of its valid
/// part, with the failure.
pub fn summarise(
    system: &dyn Mechanism,
    method: &Method,
    (q, v): (&[f64], &[f64]),
    (schedule, every): (&Schedule, u64),
    of: Of<'_>,
) -> (Option<Summary>, Option<RunError>) {
    let mut looking = Looking { every: every.max(1), of, seen: None, last: None };
    let outcome = integrate_pieces(system, method, schedule, &mut system.state(q, v), &mut looking);
    (looking.seen, outcome.err())
}

/// The observer of one trajectory.
struct Looking<'a> {
    every: u64,
    of: Of<'a>,
    seen: Option<Summary>,
    last: Option<u64>,
}

impl Looking<'_> {
    fn see(&mut self, node: &View<'_>) {
        if self.last.replace(node.k) == Some(node.k) {
            return;
        }
        let (t, energy) = (node.t, node.energy());
        let end = (self.of)(t, &node.state.unwrapped(), node.state.v());
        let seen = self.seen.get_or_insert_with(|| Summary {
            t,
            end: Vec::new(),
            low: end.clone(),
            high: end.clone(),
            energy: [energy; 2],
            energy_deviation: 0.0,
            constraint: 0.0,
        });
        for (k, value) in end.iter().enumerate() {
            (seen.low[k], seen.high[k]) = (seen.low[k].min(*value), seen.high[k].max(*value));
        }
        (seen.t, seen.end, seen.energy[1]) = (t, end, energy);
        seen.energy_deviation = larger(seen.energy_deviation, (energy - seen.energy[0]).abs());
        seen.constraint = larger(seen.constraint, node.constraint());
    }
}

impl Observer for Looking<'_> {
    fn start(&mut self, node: &View<'_>) {
        self.see(node);
    }

    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        if node.k.is_multiple_of(self.every) {
            self.see(node);
        }
        ControlFlow::Continue(())
    }

    fn end(&mut self, node: &View<'_>) {
        self.see(node);
    }
}
