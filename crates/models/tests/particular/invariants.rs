//! The size of what is conserved.

use crate::common::{draws, parameters, state};
use crate::particular::ROUNDING;
use crate::particular::geometry::{moving, spin};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrangian::{System, energy, momentum};
use models::{
    Attitude, ChaplyginBall, ContactOscillator, GaugedOscillator, KnifeEdge, Particle, RollingDisk, Snakeboard,
};
use proptest::prelude::*;

proptest! {
    /// What decouples leaves no trace in the motion: its size is that of the momenta and of the energy.
    #[test]
    fn named_invariants_have_their_size(p in parameters(), draws in draws()) {
        let [a, b, c, d, e] = p;
        let close = |ours: f64, expected: f64| assert_abs_diff_eq!(ours, expected, epsilon = 10.0 * ROUNDING);

        let disk = RollingDisk::new(a, b, c, d).unwrap();
        let (q, v) = state(&disk, &draws);
        let momenta = momentum(&disk, 0.0, &q, &v);
        let roll = disk.admissible_basis(0.0, &q).unwrap().vectors()[0];
        close(disk.spin_momentum(&v), (0..4).map(|i| momenta[i] * roll[i]).sum());
        close(disk.heading_momentum(&v), momenta[3]);
        close(energy(&disk, 0.0, &q, &v), 0.5 * ((c + a * b * b) * v[2] * v[2] + d * v[3] * v[3]));

        let particle = Particle::in_well(a, b).unwrap();
        let (q, v) = state(&particle, &draws);
        close(energy(&particle, 0.0, &q, &v), particle.energy_in_x(&q, &v) + particle.energy_in_y(&q, &v));

        let edge = KnifeEdge::new(a, b, c - d).unwrap();
        let (q, v) = state(&edge, &draws);
        close(edge.turn_momentum(&v), momentum(&edge, 0.0, &q, &v)[2]);
        let speed = v[0].hypot(v[1]);
        close(energy(&edge, 0.0, &q, &v), 0.5 * (a * speed * speed + b * v[2] * v[2]) - a * (c - d) * q[0]);

        // E = (K, omega)/2.
        let ball = ChaplyginBall::new(a, b, [c, d, e]).unwrap();
        let (q, v) = state(&ball, &draws);
        let omega = spin(&Attitude::new(moving(&[q[2], q[3], q[4], q[5]], &[v[2], v[3], v[4], v[5]])));
        let k = ball.contact_momentum(&q, &v);
        close(energy(&ball, 0.0, &q, &v), 0.5 * (0..3).map(|i| k[i] * omega[i]).sum::<f64>());

        let board = Snakeboard::new(a, b, c, d, e).unwrap();
        let (q, v) = state(&board, &draws);
        let momenta = momentum(&board, 0.0, &q, &v);
        close(board.rotor_momentum(&v), momenta[3]);
        close(board.rotor_momentum(&v), d * (v[2] + v[3]));
        close(board.steering_momentum(&v), momenta[4]);
        close(board.steering_momentum(&v), 2.0 * e * v[4]);
    }

    /// A total derivative changes the momenta, and neither motion nor energy.
    #[test]
    fn the_gauge_term_shifts_momenta_only(p in parameters(), draws in draws()) {
        let plain = ContactOscillator::new(p[0]).unwrap();
        let gauged = GaugedOscillator::new(plain, p[1]).unwrap();
        let (q, v) = state(&plain, &draws);
        let shift = momentum(&gauged, 0.0, &q, &v)[2] - momentum(&plain, 0.0, &q, &v)[2];
        assert_abs_diff_eq!(shift, p[1] * q[2].sin(), epsilon = ROUNDING);
        assert_relative_eq!(energy(&gauged, 0.0, &q, &v), energy(&plain, 0.0, &q, &v), max_relative = ROUNDING);
    }
}
