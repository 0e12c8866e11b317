//! Runs, and what is measured along them.

use dla::{OneStep, Schedule, State, View, drive};
use lagrangian::{System, position_residual};
use std::ops::ControlFlow;

/// Configuration and velocity.
pub type Place<const N: usize> = ([f64; N], [f64; N]);

/// Sees the largest value of a quantity over a run.
pub struct Largest<F> {
    pub value: f64,
    pub of: F,
}

impl<F> Largest<F> {
    pub fn of(of: F) -> Self {
        Self { value: 0.0, of }
    }
}

impl<F: FnMut(&View<'_>) -> f64> dla::Observer for Largest<F> {
    fn start(&mut self, node: &View<'_>) {
        self.value = (self.of)(node);
    }
    fn step(&mut self, node: &View<'_>, _report: &dla::Report) -> ControlFlow<()> {
        // What is not a number wins.
        self.value = lagrangian::linear::larger(self.value, (self.of)(node));
        ControlFlow::Continue(())
    }
}

/// The state after `steps` steps of length `step`.
pub fn end<Sys: System<N, M>, Method: OneStep<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    method: &mut Method,
    (q, v): Place<N>,
    step: f64,
    steps: u64,
) -> State<N> {
    let mut state = State::new(q, v, system.angles());
    drive(system, method, &Schedule { t0: 0.0, step, steps }, &mut state, ()).unwrap();
    state
}

/// The largest misses of positions and of velocities over a run.
pub fn misses<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    method: &mut dyn OneStep<N, M>,
    (q, v): Place<N>,
    step: f64,
    steps: u64,
) -> [f64; 2] {
    let mut state = State::new(q, v, system.angles());
    let mut positions =
        Largest::of(|node: &View<'_>| position_residual(system, node.t, node.state.typed().unwrap().q()));
    let mut velocities = Largest::of(|node: &View<'_>| node.constraint());
    let schedule = Schedule { t0: 0.0, step, steps };
    drive(system, method, &schedule, &mut state, (&mut positions, &mut velocities)).unwrap();
    [positions.value, velocities.value]
}

/// The distance of two states, in configuration and velocity together.
pub fn distance<const N: usize>(a: &State<N>, (q, v): &Place<N>) -> f64 {
    let place = a.unwrapped();
    (0..N).fold(0.0, |m, i| f64::max(m, (place[i] - q[i]).abs()).max((a.v()[i] - v[i]).abs()))
}

/// Asserts the slope of the least-squares line through the logarithms of errors at steps halved, within 0.1.
pub fn assert_order(name: &str, errors: [f64; 4], order: f64) {
    let e = errors.map(f64::log2);
    let slope = (3.0 * (e[0] - e[3]) + (e[1] - e[2])) / 10.0;
    println!("{name}: {errors:?}, slope {slope:.3}");
    assert!((slope - order).abs() <= 0.1, "{name}: slope {slope}, errors {errors:?}");
}
