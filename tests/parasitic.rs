//! The hidden mode of the geometric nonholonomic integrator, and its absence from the maps on the distribution.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
mod common;

use common::{sleigh, sleigh_state, state_of};
use dla::{Gni, Observer, OneStep, State, StepReport, View};
use harness::{METHODS, Method, Trend, integrate};
use lagrangian::System;
use sleigh::{CentreOfMass, SleighState};
use std::ops::ControlFlow;

/// About the stable straight motion the spin of the sleigh dies out; that of the counter-example grows at the rate
/// `asinh(kappa h)/h`, with alternating sign.
#[test]
fn the_hidden_mode_grows_at_its_rate() {
    let sleigh = sleigh();
    let system = CentreOfMass(sleigh);
    let (q, v) = SleighState { speed: 1.0, turn_rate: 1e-12, ..SleighState::default() }.to_coordinates();
    let (q, v) = system.from_blade(&q, &v);
    for h in [0.02, 0.05, 0.1] {
        let mut state = State::new(q, v, system.angles());
        let mut gni = Gni::<_, 3>::default();
        let (mut growth, mut sign_changes, mut before) = (Trend::default(), 0, 0.0);
        let steps = (40.0 / h) as u64;
        for k in 0..steps {
            OneStep::<_, 3, 1>::step(&mut gni, &system, h * k as f64, h, &mut state).unwrap();
            let spin = state.v()[2];
            // From where the growing part has outgrown the decaying one, to where it is no longer small.
            if spin.abs() < 1e-3 && h * k as f64 > 20.0 {
                growth.add(h * k as f64, spin.abs().ln());
                sign_changes += u32::from(spin * before < 0.0);
            }
            before = spin;
        }
        let (rate, theory) = (growth.slope().unwrap(), (sleigh.spin_gain() * h).asinh() / h);
        println!("h = {h}: the hidden mode grows at {rate:.5}, asinh(kappa h)/h = {theory:.5}");
        assert!((rate / theory - 1.0).abs() < 1e-3, "h = {h}: {rate}, expected {theory}");
        assert!(sign_changes > 50);
    }
}

/// The largest spin in the second half of a run of 200 s.
struct Late(f64);

impl<Sys> Observer<Sys, 3, 1> for Late {
    fn start(&mut self, _node: &View<'_, Sys, 3>) {}
    fn step(&mut self, node: &View<'_, Sys, 3>, _report: &StepReport<1>) -> ControlFlow<()> {
        if node.t > 100.0 {
            self.0 = self.0.max(node.state.v()[2].abs());
        }
        ControlFlow::Continue(())
    }
}

/// No other method has such a mode: the stable straight motion stays straight, for as long as one looks.
#[test]
fn no_other_method_has_it() {
    let sleigh = sleigh();
    let start = SleighState { speed: 1.0, turn_rate: 1e-6, heading: 0.3, ..SleighState::default() };
    for info in METHODS {
        let method = Method::named(info.name, None).unwrap();
        let mut state = state_of(&sleigh, &start);
        let schedule = dla::Schedule { t0: 0.0, step: 0.05, steps: 4_000 };
        let mut largest = Late(0.0);
        integrate(&sleigh, &method, &schedule, &mut state, &mut largest).unwrap();
        let end = sleigh_state(&state);
        println!("{:<15} spin at most {:.1e} after t = 100, speed {}", info.name, largest.0, end.speed);
        if info.name == "gni" {
            assert!(largest.0 > 1e-2, "the counter-example has lost its point: {end:?}");
        } else {
            // Rounding may leave a spin of the size of rounding, and no more.
            assert!(largest.0 < 1e-14, "{}: {end:?}", info.name);
        }
    }
}
