//! Attitude by spinning the rotor.

use crate::geometry::run;
use approx::assert_relative_eq;
use dla::State;
use lagrangian::System;
use sleigh::{Flywheel, Sleigh, SleighState, TimeFunction};

const ROTOR: f64 = 0.2;

/// Where a motor that pushes and brakes leads from rest: the change of heading, the angle of the rotor, the speed.
fn driven(offset: f64, strength: f64) -> [f64; 3] {
    let sleigh = Sleigh::new(1.3, 0.7, offset).unwrap();
    let torque = TimeFunction::Sine { amplitude: strength, frequency: 1.0, phase: 0.0 };
    let system = Flywheel::new(sleigh, ROTOR, Some(torque)).unwrap();
    let mut state = State::new([0.0; 4], [0.0; 4], system.angles());
    run(&system, "dla", (std::f64::consts::TAU / 400.0, 400), &mut state, &mut ());
    let q = state.unwrapped();
    let v = state.v();
    let speed = SleighState::from_coordinates(&[q[0], q[1], q[2]], &[v[0], v[1], v[2]]).speed;
    [q[2], q[3], speed]
}

/// `I omega + I_r (omega + psi') = 0` at all times, from rest, where the centre of mass is at the blade.
#[test]
fn a_balanced_sleigh_turns_against_its_rotor() {
    let [heading, rotor, speed] = driven(0.0, 1.0);
    assert!(heading < -1.0);
    assert_relative_eq!(heading, -ROTOR / (0.7 + ROTOR) * rotor, max_relative = 1e-12);
    assert!(speed.abs() < 1e-14);
}

/// With the centre of mass ahead the rotor still turns the sleigh, to first order by `-I_r/(J + I_r)` of its angle; and it pushes
/// it forward, never back: `u' = a omega^2`.
#[test]
fn an_unbalanced_sleigh_is_pushed_forward_too() {
    let inertia = 0.7 + 1.3 * 0.4 * 0.4;
    let off = |strength: f64| {
        let [heading, rotor, speed] = driven(0.4, strength);
        assert!(speed > 0.0);
        (heading + ROTOR / (inertia + ROTOR) * rotor).abs()
    };
    // m a u omega is of third order in the motor.
    assert_relative_eq!((off(0.1) / off(0.05)).log2(), 3.0, epsilon = 0.05);
}
