//! Time reversal and rigid motions.

use crate::common::{advanced, backward, midpoint_forms, sleigh, sleigh_state, sleighs, starts, state_of};
use dla::{Dla, OneStep, Rk4, State};
use lagrangian::System;
use proptest::prelude::*;
use sleigh::{CentreOfMass, ClosedMap, Sleigh, SleighState};

const STEP: f64 = 0.05;
const STEPS: u64 = 200;

/// How far a run there and back ends from its start.
fn there_and_back<Sys, Method>(system: &Sys, method: &mut Method, state: State<3>) -> f64
where
    Sys: System<3, 1>,
    Method: OneStep<3, 1>,
{
    let there = advanced(system, method, STEP, STEPS, state);
    let back = advanced(system, method, STEP, STEPS, there.reversed()).reversed();
    let (q0, q1) = (state.unwrapped(), back.unwrapped());
    (0..3).map(|i| (q0[i] - q1[i]).abs().max((state.v()[i] - back.v()[i]).abs())).fold(0.0, f64::max)
}

#[test]
fn runs_return_to_their_start() {
    let sleigh = sleigh();
    let state = state_of(&sleigh, &backward());
    for (name, mut method) in midpoint_forms(sleigh) {
        let error = there_and_back(&sleigh, &mut method, state);
        println!("{name}: {error:.1e}");
        assert!(error <= 1e-12, "{name} returns within {error:e}");
    }
    let error = there_and_back(&sleigh, &mut Dla::trapezoid(), state);
    assert!(error <= 1e-12, "trapezoid returns within {error:e}");

    let system = CentreOfMass(sleigh);
    let (q, v) = backward().to_coordinates();
    let (q, v) = system.from_blade(&q, &v);
    let error = there_and_back(&system, &mut Dla::midpoint(), State::new(q, v, system.angles()));
    assert!(error <= 1e-12, "in coordinates of the centre of mass: {error:e}");

    // The controls: methods that are not their own adjoint do not return.
    let error = there_and_back(&sleigh, &mut Rk4, state);
    assert!(error > 1e-8, "rk4 returns within {error:e}");
    let error = there_and_back(&sleigh, &mut Dla::alpha(0.25).unwrap(), state);
    assert!(error > 1e-4, "alpha = 1/4 returns within {error:e}");
}

/// The rule with `alpha` and the one with `1 - alpha` undo each other.
#[test]
fn the_alpha_rule_and_its_adjoint() {
    let sleigh = sleigh();
    let state = state_of(&sleigh, &backward());
    let there = advanced(&sleigh, &mut Dla::alpha(0.2).unwrap(), STEP, STEPS, state);
    let back = advanced(&sleigh, &mut Dla::alpha(0.8).unwrap(), -STEP, STEPS, there);
    for i in 0..3 {
        assert!((back.unwrapped()[i] - state.unwrapped()[i]).abs() <= 1e-11);
    }
}

/// Turned by `angle`, then moved by `(dx, dy)`.
fn moved(state: &SleighState, angle: f64, dx: f64, dy: f64) -> SleighState {
    let (sin, cos) = angle.sin_cos();
    SleighState {
        x: cos * state.x - sin * state.y + dx,
        y: sin * state.x + cos * state.y + dy,
        heading: state.heading + angle,
        ..*state
    }
}

fn mirrored(state: &SleighState) -> SleighState {
    SleighState { y: -state.y, heading: -state.heading, turn_rate: -state.turn_rate, ..*state }
}

fn assert_same(a: &SleighState, b: &SleighState, tolerance: f64) -> Result<(), TestCaseError> {
    let size = 1.0 + a.x.abs().max(a.y.abs()).max(a.heading.abs());
    for (x, y) in [(a.x, b.x), (a.y, b.y), (a.heading, b.heading), (a.speed, b.speed), (a.turn_rate, b.turn_rate)] {
        prop_assert!((x - y).abs() <= tolerance * size, "{a:?} and {b:?}");
    }
    Ok(())
}

/// Steps short enough that the map has its solution: `h |omega| < 1` and `h c |u| < 1`, with room for growth.
fn fits(sleigh: &Sleigh, start: &SleighState) -> bool {
    let speed = start.speed.hypot((sleigh.pivot_inertia() / sleigh.mass()).sqrt() * start.turn_rate);
    STEP * sleigh.spin_gain().abs() * speed < 0.5
}

proptest! {
    /// A step of the moved sleigh is the moved step.
    #[test]
    fn rigid_motions_commute_with_the_step(
        sleigh in sleighs(), start in starts(), angle in -7.0..7.0f64, dx in -10.0..10.0f64, dy in -10.0..10.0f64,
    ) {
        prop_assume!(fits(&sleigh, &start));
        for (_, mut method) in midpoint_forms(sleigh) {
            let step = |method: &mut _, start: &SleighState| {
                sleigh_state(&advanced(&sleigh, method, STEP, 1, state_of(&sleigh, start)))
            };
            let moved_step = step(&mut method, &moved(&start, angle, dx, dy));
            assert_same(&moved_step, &moved(&step(&mut method, &start), angle, dx, dy), 1e-12)?;
            assert_same(&step(&mut method, &mirrored(&start)), &mirrored(&step(&mut method, &start)), 1e-12)?;
        }
        let step = |start: &SleighState| {
            sleigh_state(&advanced(&sleigh, &mut Dla::trapezoid(), STEP, 1, state_of(&sleigh, start)))
        };
        assert_same(&step(&moved(&start, angle, dx, dy)), &moved(&step(&start), angle, dx, dy), 1e-12)?;
    }

    /// The sleigh seen from behind: the centre of mass on the other side, the speed reversed, half a turn.
    #[test]
    fn the_other_end_of_the_blade(sleigh in sleighs(), start in starts()) {
        prop_assume!(fits(&sleigh, &start));
        let other = Sleigh::new(sleigh.mass(), sleigh.inertia(), -sleigh.offset()).unwrap();
        let flip = |s: &SleighState| {
            SleighState { heading: s.heading + std::f64::consts::PI, speed: -s.speed, ..*s }
        };
        let step = |sleigh: &Sleigh, start: &SleighState| {
            let method = &mut ClosedMap::of(*sleigh);
            sleigh_state(&advanced(sleigh, method, STEP, 1, state_of(sleigh, start)))
        };
        assert_same(&step(&other, &flip(&start)), &flip(&step(&sleigh, &start)), 1e-12)?;
    }
}
