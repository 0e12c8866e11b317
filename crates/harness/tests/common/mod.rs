//! What the whole-program tests share.

use dla::{Dla, Form, OneStep, Schedule, State, Stepper, drive};
use lagrangian::System;
use proptest::prelude::*;
use sleigh::{ClosedMap, Sleigh, SleighState};

/// The sleigh of the bundled scene `turnaround`.
pub fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// Its start: backward, with a little spin.
pub fn backward() -> SleighState {
    SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }
}

/// Random sleighs: two decades of mass and inertia, the centre of mass ahead, behind, nearly over and over the blade.
pub fn sleighs() -> impl Strategy<Value = Sleigh> {
    let size = || (-1.0..1.0f64).prop_map(|e| 10f64.powf(e));
    (size(), size(), prop_oneof![4 => -1.0..1.0, 1 => Just(0.0), 1 => -1e-9..1e-9])
        .prop_map(|(m, i, a)| Sleigh::new(m, i, a).unwrap())
}

pub fn starts() -> impl Strategy<Value = SleighState> {
    (
        -5.0..5.0f64,
        -5.0..5.0f64,
        -10.0..10.0f64,
        -2.0..2.0f64,
        prop_oneof![4 => -1.5..1.5, 1 => -1e-9..1e-9, 1 => Just(0.0)],
    )
        .prop_map(|(x, y, heading, speed, turn_rate)| SleighState { x, y, heading, speed, turn_rate })
}

pub fn state_of<Sys: System<3, 1>>(system: &Sys, start: &SleighState) -> State<3> {
    let (q, v) = start.to_coordinates();
    State::new(q, v, system.angles())
}

/// Makes `steps` steps of `h` and returns the state at the end.
pub fn advanced<Sys, Method>(system: &Sys, method: &mut Method, h: f64, steps: u64, state: State<3>) -> State<3>
where
    Sys: System<3, 1>,
    Method: OneStep<3, 1>,
{
    let mut state = state;
    drive(system, method, &Schedule { t0: 0.0, step: h, steps }, &mut state, ()).expect("the steps succeed");
    state
}

pub fn sleigh_state(state: &State<3>) -> SleighState {
    SleighState::from_coordinates(&state.unwrapped(), state.v())
}

/// The state of a sleigh at a configuration and a velocity.
pub fn sleigh_at(q: &[f64], v: &[f64]) -> SleighState {
    SleighState::from_coordinates(&row(q), &row(v))
}

/// The first numbers of a list.
pub fn row<const N: usize>(x: &[f64]) -> [f64; N] {
    *x.first_chunk().unwrap()
}

/// The midpoint method by the closed map of this sleigh, in the basis, and with multipliers.
pub fn midpoint_forms(sleigh: Sleigh) -> [(&'static str, Stepper<'static, 3, 1>); 3] {
    [
        ("closed", Box::new(ClosedMap::of(sleigh))),
        ("basis", Box::new(Dla::midpoint())),
        ("multipliers", Box::new(Dla::midpoint().solved(Form::Multipliers))),
    ]
}
