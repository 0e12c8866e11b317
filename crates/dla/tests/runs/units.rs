//! The same motion in another unit of time, in which forces are too large for a number and their impulses are not.

use crate::runs::{sleigh, system};
use approx::assert_relative_eq;
use dla::{Dla, Form, Gni, OneStep, Schedule, State, drive};
use lagrangian::System;
use sleigh::{ClosedMap, SleighState};

/// Blade velocity and spin at the end of ten seconds of the turn-around, in units of `unit` m/s.
fn end(mut method: impl OneStep<3, 1>, unit: f64) -> [f64; 3] {
    let sleigh = system();
    let start = SleighState { speed: -unit, turn_rate: 0.3 * unit, ..SleighState::default() };
    let (q, v) = start.to_coordinates();
    let mut state = State::new(q, v, sleigh.angles());
    let schedule = Schedule { t0: 0.0, step: 0.05 / unit, steps: 200 };
    drive(&sleigh, &mut method, &schedule, &mut state, ()).unwrap();
    state.v().map(|v| v / unit)
}

#[test]
fn fast_motions_are_those_of_another_unit() {
    fn same<M: OneStep<3, 1>>(method: impl Fn() -> M) {
        let known = end(method(), 1.0);
        for unit in [1e150, 1e155, 1e160, 1e200, 1e300] {
            let fast = end(method(), unit);
            for i in 0..3 {
                // Rounding of 200 steps, which the turn multiplies by less than a hundred.
                assert_relative_eq!(fast[i], known[i], max_relative = 2e4 * f64::EPSILON);
            }
        }
    }
    same(Dla::midpoint);
    same(|| ClosedMap::of(sleigh()));
    same(|| Dla::midpoint().solved(Form::Multipliers));
    same(Dla::trapezoid);
    same(|| Dla::alpha(0.5).unwrap());
    same(Gni::default);
}
