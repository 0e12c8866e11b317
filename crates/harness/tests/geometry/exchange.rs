//! The turn-around: speed becomes spin and spin becomes speed, and no force does any work.

use crate::common::{row, sleigh_at};
use crate::geometry::run;
use approx::assert_relative_eq;
use dla::{State, Trajectory};
use lagrangian::{Motion, System, constraint_residual};
use sleigh::{Sleigh, SleighState};

#[test]
fn the_energy_goes_from_speed_to_spin_and_back_and_the_blade_does_no_work() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    let mut nodes = Trajectory::every(1);
    run(&sleigh, "dla", (0.01, 4000), &mut State::new(q, v, sleigh.angles()), &mut nodes);
    let (mut spin, mut force) = (0.0_f64, 0.0_f64);
    for node in nodes.nodes() {
        let (q, v) = (row(&node.q), row(&node.v));
        let state = SleighState::from_coordinates(&q, &v);
        let (u, omega) = (state.speed, state.turn_rate);
        let lambda = Motion::of(&sleigh, node.t, &q, &v).unwrap().multiplier[0];
        // lambda = m u omega I/J, along n, where nothing moves.
        assert_relative_eq!(lambda, u * omega / 1.25, epsilon = 1e-15);
        let power = lambda * constraint_residual::<_, _, 3, 1>(&sleigh, node.t, &q, &v)[0];
        assert!(power.abs() < 4.0 * f64::EPSILON * lambda.abs().max(1e-3), "{power}");
        // On the ellipse of the energy, to the second order of the method.
        assert_relative_eq!(0.5 * u * u + 0.625 * omega * omega, 0.5 + 0.00625, epsilon = 1e-5);
        spin = spin.max(0.625 * omega * omega);
        force = force.max(lambda.abs());
    }
    // The positive controls: there is a force, and all of the energy has been in the spin.
    assert!(force > 0.1 && spin > 0.506, "{force} {spin}");
    let last = nodes.nodes().last().unwrap();
    assert!(sleigh_at(&last.q, &last.v).speed > 1.0);
}
