//! Runs, and what is measured along them.

use dla::{Observer, OneStep, Report, RunError, Schedule, State, View, drive};
use lagrangian::System;
use lagrangian::linear::larger;
use std::ops::ControlFlow;

/// Configuration and velocity.
pub type Place<const N: usize> = ([f64; N], [f64; N]);

/// The largest values of some quantities over a run.
struct Largest<F, const K: usize> {
    values: [f64; K],
    of: F,
}

impl<F, const K: usize> Observer for Largest<F, K>
where
    F: FnMut(&View<'_>) -> [f64; K],
{
    fn start(&mut self, node: &View<'_>) {
        self.values = (self.of)(node);
    }
    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        let now = (self.of)(node);
        // What is not a number wins.
        self.values = std::array::from_fn(|k| larger(self.values[k], now[k]));
        ControlFlow::Continue(())
    }
}

/// The largest values of some quantities over a run of `steps` steps of length `step` (s), and how it ends.
pub fn largest<Sys, F, const N: usize, const M: usize, const K: usize>(
    system: &Sys,
    method: &mut dyn OneStep<N, M>,
    (q, v): Place<N>,
    (step, steps): (f64, u64),
    of: F,
) -> ([f64; K], Result<State<N>, RunError>)
where
    Sys: System<N, M>,
    F: FnMut(&View<'_>) -> [f64; K],
{
    let mut state = State::new(q, v, system.angles());
    let mut seen = Largest { values: [0.0; K], of };
    let outcome = drive(system, method, &Schedule { t0: 0.0, step, steps }, &mut state, &mut seen);
    (seen.values, outcome.map(|_| state))
}

/// Asserts the slope of the least-squares line through the logarithms of errors at steps halved, within 0.1.
pub fn assert_order(name: &str, errors: [f64; 4], order: f64) {
    let e = errors.map(f64::log2);
    let slope = (3.0 * (e[0] - e[3]) + (e[1] - e[2])) / 10.0;
    println!("{name}: {errors:?}, slope {slope:.3}");
    assert!((slope - order).abs() <= 0.1, "{name}: slope {slope}, errors {errors:?}");
}

/// Asserts the slope from one error to that at half the step: where four of them are within 0.1, their first two are within 0.24.
pub fn assert_halving(name: &str, [coarse, fine]: [f64; 2], order: f64) {
    let slope = (coarse / fine).log2();
    println!("{name}: {coarse:e}, {fine:e}, slope {slope:.3}");
    assert!((slope - order).abs() <= 0.24, "{name}: slope {slope}, errors {coarse:e}, {fine:e}");
}
