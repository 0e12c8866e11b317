//! A million steps: the blade of `dla` does not slip, that of `rk4` does.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
mod common;

use common::{sleigh, state_of};
use dla::{Observer, Schedule, StepReport, View};
use harness::{Method, integrate};
use lagrangian::System;
use sleigh::{Sleigh, SleighState};
use std::ops::ControlFlow;

const STEPS: u64 = 1_000_000;

/// The largest residual in each tenth of the run.
struct Tenths([f64; 10]);

impl<Sys: System<3, 1>> Observer<Sys, 3, 1> for Tenths {
    fn start(&mut self, _node: &View<'_, Sys, 3>) {}
    fn step(&mut self, node: &View<'_, Sys, 3>, _report: &StepReport<1>) -> ControlFlow<()> {
        let tenth = &mut self.0[((node.k - 1) * 10 / STEPS) as usize];
        *tenth = tenth.max(node.constraint());
        ControlFlow::Continue(())
    }
}

fn residuals(sleigh: &Sleigh, start: &SleighState, name: &str) -> [f64; 10] {
    let method = Method::named(name, None).unwrap();
    let mut tenths = Tenths([0.0; 10]);
    let mut state = state_of(sleigh, start);
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: STEPS };
    integrate(sleigh, &method, &schedule, &mut state, &mut tenths).unwrap();
    let shown = tenths.0.map(|r| format!("{r:.1e}")).join(" ");
    println!("{name:<15} a = {}: {shown}", sleigh.offset());
    tenths.0
}

#[test]
fn a_million_steps_do_not_slip() {
    // Forward with spin: the sleigh straightens and runs to x ~ 5e4 m. And balanced: circles for ever.
    let straightening = (sleigh(), SleighState { speed: 1.0, turn_rate: 1.0, ..SleighState::default() });
    let circling = (Sleigh::new(1.0, 1.0, 0.0).unwrap(), SleighState { speed: 1.0, turn_rate: 0.5, ..straightening.1 });
    for (sleigh, start) in [straightening, circling] {
        for name in ["dla", "dla-trapezoid", "rk4-projected", "rk4-reduced"] {
            let tenths = residuals(&sleigh, &start, name);
            // One rounding each of the direction, the velocity and the residual, of a speed of order one.
            assert!(tenths.iter().all(|r| *r <= 1e-14), "{name} slips: {tenths:?}");
            // No growth: the last tenth is not above what one rounding more or less can do to the first.
            assert!(tenths[9] <= 2.0 * tenths[0] + f64::EPSILON, "{name}: the slip grows, {tenths:?}");
        }
    }
}

/// The control: the same measurement sees the slip of a method that does not hold the constraint.
#[test]
fn a_million_steps_of_rk4_do_slip() {
    let start = SleighState { speed: 1.0, turn_rate: 1.0, ..SleighState::default() };
    let slip = residuals(&sleigh(), &start, "rk4").iter().copied().fold(0.0, f64::max);
    let held = residuals(&sleigh(), &start, "dla").iter().copied().fold(0.0, f64::max);
    println!("largest slip: rk4 {slip:.1e}, dla {held:.1e}");
    assert!(slip > 1e-8, "rk4 slips by {slip:e} only");
    assert!(slip > 1e6 * held);
}
