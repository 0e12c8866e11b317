//! The reduced step of a sleigh that is pushed against the general one: the same map, to rounding.

use crate::effects::tools::{laden, moving, sleigh};
use dla::{Dla, Form, OneStep, State};
use lagrangian::{System, constraint_residual};
use scene::AnyEffect;
use sleigh::TimeFunction;
use sleigh::effects::{Bowl, Drag, EggCrate, Thrust, Torque};

const STEP: f64 = 0.05;

fn bowl() -> AnyEffect {
    AnyEffect::Bowl(Bowl::new([0.7, 0.4], [0.2, -0.1]).unwrap())
}

fn crate_of_eggs() -> AnyEffect {
    AnyEffect::EggCrate(EggCrate::new(0.3, [1.0, 1.2]).unwrap())
}

fn drag() -> AnyEffect {
    AnyEffect::Drag(Drag::new(0.3, 0.2).unwrap())
}

/// A thrust and a torque that swing.
fn pushes() -> [AnyEffect; 2] {
    let swing = |phase| TimeFunction::Sine { amplitude: 0.5, frequency: 2.0, phase };
    [AnyEffect::Thrust(Thrust::new(swing(0.3)).unwrap()), AnyEffect::Torque(Torque::new(swing(1.1)).unwrap())]
}

/// Along a run of `count` steps by the first method, the largest difference that one step of the second makes, in velocities and impulses.
fn differences(effects: Vec<AnyEffect>, form: Form, count: u32) -> [f64; 2] {
    let system = laden(sleigh(), effects);
    let (q, v) = moving().to_coordinates();
    let mut state = State::new(q, v, system.angles());
    let mut worst = [0.0f64; 2];
    for k in 0..count {
        let (t, mut other) = (STEP * f64::from(k), state);
        let best = Dla::midpoint().step(&system, t, STEP, &mut state).unwrap();
        let report = Dla::midpoint().solved(form).step(&system, t, STEP, &mut other).unwrap();
        for i in 0..3 {
            worst[0] = worst[0].max((state.v()[i] - other.v()[i]).abs());
            worst[0] = worst[0].max((state.q()[i] - other.q()[i]).abs());
        }
        for end in 0..2 {
            worst[1] = worst[1].max((best.impulses[end][0] - report.impulses[end][0]).abs());
        }
        let slip: [f64; 1] = constraint_residual(&system, t + STEP, state.q(), state.v());
        let speed = state.v()[0].hypot(state.v()[1]);
        assert!(slip[0].abs() <= 1e-15 * speed.max(1.0), "{slip:?} at {speed} m/s");
    }
    worst
}

/// Velocities below four and momenta below ten, with the condition of the mass matrix, six.
fn same_map(count: u32) {
    for form in [Form::Best, Form::Multipliers] {
        let [thrust, torque] = pushes();
        let all = vec![bowl(), crate_of_eggs(), drag(), thrust, torque];
        for effects in
            [vec![bowl()], vec![crate_of_eggs()], vec![bowl(), crate_of_eggs()], vec![drag()], pushes().to_vec(), all]
        {
            let [velocities, impulses] = differences(effects, form, count);
            println!("{form:?}: velocities {velocities:.1e}, impulses {impulses:.1e}");
            assert!(velocities <= 4e-14 && impulses <= 4e-13, "{velocities:e}, {impulses:e}");
        }
    }
}

#[test]
fn both_forms_are_the_same_map() {
    same_map(200);
}

#[test]
#[ignore = "slow"]
fn both_forms_are_the_same_map_in_full() {
    same_map(2000);
}

/// There and back; drag is the control.
#[test]
fn the_step_goes_back() {
    let there_and_back = |effects: Vec<AnyEffect>| {
        let system = laden(sleigh(), effects);
        let (q, v) = moving().to_coordinates();
        let start = State::new(q, v, system.angles());
        let run = |mut state: State<3>| {
            for _ in 0..200 {
                Dla::midpoint().step(&system, 0.0, STEP, &mut state).unwrap();
            }
            state
        };
        let back = run(run(start).reversed()).reversed();
        (0..3).map(|i| (back.q()[i] - q[i]).abs().max((back.v()[i] - v[i]).abs())).fold(0.0, f64::max)
    };
    let error = there_and_back(vec![bowl(), crate_of_eggs()]);
    assert!(error <= 1e-11, "returns within {error:e}");
    let error = there_and_back(vec![bowl(), AnyEffect::Drag(Drag::new(0.1, 0.1).unwrap())]);
    assert!(error > 1e-3, "with drag within {error:e}");
}
