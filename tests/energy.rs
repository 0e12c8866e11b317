//! What the methods keep of the energy of the free sleigh.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
mod common;

use common::{sleigh, state_of};
use dla::{Dla, OneStep};
use dla::{Observer, Schedule, State, StepReport, View, drive};
use lagrangian::System;
use sleigh::{CentreOfMass, Sleigh, SleighState};
use std::ops::ControlFlow;

/// The largest energy error of a run, relative.
#[derive(Default)]
struct EnergyError {
    initial: f64,
    largest: f64,
}

impl<Sys: System<3, 1>> Observer<Sys, 3, 1> for EnergyError {
    fn start(&mut self, node: &View<'_, Sys, 3>) {
        self.initial = node.energy();
    }
    fn step(&mut self, node: &View<'_, Sys, 3>, _report: &StepReport<1>) -> ControlFlow<()> {
        self.largest = self.largest.max((node.energy() / self.initial - 1.0).abs());
        ControlFlow::Continue(())
    }
}

fn energy_error<Sys, Method>(system: &Sys, mut method: Method, mut state: State<3>, steps: u64) -> f64
where
    Sys: System<3, 1>,
    Method: OneStep<Sys, 3, 1>,
{
    let mut error = EnergyError::default();
    drive(system, &mut method, &Schedule { t0: 0.0, step: 0.05, steps }, &mut state, &mut error).unwrap();
    error.largest
}

fn at_centre_of_mass(system: &CentreOfMass, start: &SleighState) -> State<3> {
    let (q, v) = start.to_coordinates();
    let (q, v) = system.from_blade(&q, &v);
    State::new(q, v, system.angles())
}

/// Where the mass matrix and `A M^-1 A'` are constant, the trapezoidal method keeps the kinetic energy.
#[test]
fn the_trapezoid_at_the_centre_of_mass_keeps_it() {
    let start = SleighState { speed: -1.0, turn_rate: 0.4, ..SleighState::default() };
    for offset in [0.5, -0.3, 2.0] {
        let sleigh = Sleigh::new(1.3, 0.8, offset).unwrap();
        let system = CentreOfMass(sleigh);
        let steps = 2_000;
        let kept = energy_error(&system, Dla::trapezoid(), at_centre_of_mass(&system, &start), steps);
        println!("a = {offset}: {kept:.1e}");
        // One rounding of the energy a step, at worst all in the same direction.
        assert!(kept <= f64::EPSILON * steps as f64, "a = {offset}: relative energy error {kept:e}");

        // The controls: the midpoint rule there, and the trapezoidal rule at the blade, do not.
        let midpoint = energy_error(&system, Dla::midpoint(), at_centre_of_mass(&system, &start), 400);
        let at_blade = energy_error(&sleigh, Dla::trapezoid(), state_of(&sleigh, &start), 400);
        assert!(midpoint > 1e-8, "midpoint: {midpoint:e}");
        assert!(at_blade > 1e-8, "at the blade: {at_blade:e}");
    }
}

/// The error of the other symmetric members stays of second order while the sleigh turns, and freezes with the spin.
#[test]
fn the_midpoint_rule_bounds_it_on_the_free_sleigh() {
    let start = SleighState { speed: -1.0, turn_rate: 0.4, ..SleighState::default() };
    let sleigh = sleigh();
    let short = energy_error(&sleigh, Dla::midpoint(), state_of(&sleigh, &start), 1_000);
    let long = energy_error(&sleigh, Dla::midpoint(), state_of(&sleigh, &start), 20_000);
    assert!(short < 1e-3);
    assert!((long - short).abs() < 1e-12, "the error of a motion that has died out still grows: {short:e}, {long:e}");
}
