//! Constraints on positions, affine ones, and one that is not affine.

use crate::common::{draws, parameters, state};
use crate::particular::ROUNDING;
use approx::assert_abs_diff_eq;
use lagrangian::{Dual, Motion, System, energy, reaction_rows};
use models::{CompoundPendulum, IsokineticParticle, Model, SleighOnArm, TurntableBall};
use proptest::prelude::*;
use std::array::from_fn;

/// Values along a motion: `x` at the rate `rate`.
fn moving<const N: usize>(x: &[f64; N], rate: &[f64; N]) -> [Dual<f64, 1>; N] {
    from_fn(|i| Dual { re: x[i], eps: [rate[i]] })
}

proptest! {
    /// The two formulations, the invariants, the closed form and the reaction of the isokinetic particle.
    #[test]
    fn the_isokinetic_particle(p in parameters(), draws in draws(), t in -2.0..2.0f64) {
        let particle = IsokineticParticle::new(p[0], p[1], p[2] - p[3]).unwrap();
        let (q, v) = state(&particle, &draws);
        let hand = particle.accelerations_by_hand(0.0, &q, &v);
        let machine = Motion::automatic(&particle, 0.0, &q, &v).unwrap();
        // The reaction is along the velocity, `phi_v = v/c`.
        let [row] = reaction_rows(&particle, 0.0, &q, &v);
        for i in 0..2 {
            assert_abs_diff_eq!(hand[i], machine.acceleration[i], epsilon = ROUNDING);
            assert_abs_diff_eq!(row[i], v[i] / p[1], epsilon = ROUNDING);
        }
        // Their terms are the values times the rate of the turn, up to 25 / s.
        for (name, rate) in particle.invariants(&moving(&q, &v), &moving(&v, &hand)) {
            prop_assert!(rate.eps[0].abs() <= 25.0 * ROUNDING * (1.0 + rate.re.abs()), "{name}: {rate:?}");
        }

        // A closed form that starts where it should, at the right rate, and is a flow: so it solves the equations.
        let start = (q, v);
        let (q1, v1) = particle.exact_from(&start, t).unwrap();
        let there = particle.exact_from(&particle.exact_from(&start, 0.3 * t).unwrap(), 0.7 * t).unwrap();
        let near = |dt: f64| particle.exact_from(&start, t + dt).unwrap();
        let (up, down) = (near(1e-4), near(-1e-4));
        let a = particle.accelerations_by_hand(t, &q1, &v1);
        for i in 0..2 {
            // Places are quotients of logarithms by a strength that may be small.
            let lost = 1.0 + 10.0 / (p[2] - p[3]).abs();
            assert_abs_diff_eq!(there.0[i], q1[i], epsilon = ROUNDING * lost);
            assert_abs_diff_eq!(there.1[i], v1[i], epsilon = 10.0 * ROUNDING);
            // Central differences over 2e-4: h^2/6 of third derivatives below 300, and the rounding over h.
            assert_abs_diff_eq!((up.0[i] - down.0[i]) / 2e-4, v1[i], epsilon = 5e-7 + 1e-11 * lost);
            assert_abs_diff_eq!((up.1[i] - down.1[i]) / 2e-4, a[i], epsilon = 5e-6);
        }
        // `div(rho X) = 0` for `X = (c cos phi, c sin phi, -F/(m c) sin phi)`.
        let place = [Dual { re: q[0], eps: [1.0] }, Dual::fixed(q[1])];
        let density = particle.density(&place).unwrap();
        let turning = (p[2] - p[3]) / (p[0] * p[1]);
        let divergence = density.eps[0] * v[0] - density.re * turning * v[0] / p[1];
        assert_abs_diff_eq!(divergence, 0.0, epsilon = 25.0 * ROUNDING * (1.0 + density.re));
    }

    /// The centre's circle has the rate 2/7 for a solid ball, and is passed as the closed form says.
    #[test]
    fn the_ball_on_the_table(p in parameters(), draws in draws(), t in -2.0..2.0f64) {
        let [m, r, _, rate, _] = p;
        let solid = TurntableBall::new(m, r, 0.4 * m * r * r, rate).unwrap();
        assert_abs_diff_eq!(solid.circling(), 2.0 / 7.0 * rate, epsilon = ROUNDING);
        let start = state(&solid, &draws);
        let (q, v) = &start;
        let a = solid.accelerations_by_hand(0.0, q, v);
        let (place, velocity) = solid.centre_from(&start, t);
        let w = solid.circling();
        // Both keep the circle's centre, and the speed.
        let kept = |p: [f64; 2], v: [f64; 2]| [p[0] - v[1] / w, p[1] + v[0] / w, v[0].hypot(v[1])];
        let (before, after) = (kept([q[0], q[1]], [v[0], v[1]]), kept(place, velocity));
        for i in 0..3 {
            assert_abs_diff_eq!(before[i], after[i], epsilon = 100.0 * ROUNDING / w);
        }
        assert_abs_diff_eq!(a[0], -w * v[1], epsilon = ROUNDING);
        assert_abs_diff_eq!(a[1], w * v[0], epsilon = ROUNDING);
        // The contact point has the table's velocity, with the spin read off the matrix of the quaternion.
        let [x, y, _] = solid.spin(q, v);
        assert_abs_diff_eq!(v[0] - r * y, -rate * q[1], epsilon = 10.0 * ROUNDING);
        assert_abs_diff_eq!(v[1] + r * x, rate * q[0], epsilon = 10.0 * ROUNDING);
        // E = m/2 |P'|^2 + I/2 |omega|^2.
        let spin: f64 = solid.spin(q, v).iter().map(|w| w * w).sum();
        let expected = 0.5 * m * (v[0] * v[0] + v[1] * v[1]) + 0.2 * m * r * r * spin;
        assert_abs_diff_eq!(energy(&solid, 0.0, q, v), expected, epsilon = 1e3 * ROUNDING);
    }

    /// The hitch stays at the arm's length, and the heading relative to the arm turns at `(l/d) cos(psi) - 1` times its rate.
    #[test]
    fn the_sleigh_on_the_arm(p in parameters(), draws in draws()) {
        let [m, i, hitch, beyond, pull] = p;
        let arm = hitch + beyond;
        let sleigh = SleighOnArm::new(m, i, 0.3, hitch, arm, pull).unwrap();
        let (q, v) = state(&sleigh, &draws);
        let [x, y, theta] = moving(&q, &v);
        let (sin, cos) = lagrangian::Scalar::sin_cos(theta);
        let at = [x + cos * hitch, y + sin * hitch];
        assert_abs_diff_eq!(at[0].re.hypot(at[1].re), arm, epsilon = ROUNDING);
        let turn = (at[0].re * at[1].eps[0] - at[1].re * at[0].eps[0]) / (arm * arm);
        let psi = q[2] - at[1].re.atan2(at[0].re);
        assert_abs_diff_eq!(v[2] - turn, (arm / hitch * psi.cos() - 1.0) * turn, epsilon = 100.0 * ROUNDING);
        let [[blade, _, _], _] = sleigh.constraint(0.0, &q).0;
        assert_abs_diff_eq!(blade, -q[2].sin(), epsilon = ROUNDING);
    }

    /// A pendulum's energy is that of its angle.
    #[test]
    fn the_compound_pendulum(p in parameters(), angle in -3.0..3.0f64, rate in -2.0..2.0f64) {
        let [m, i, a, g, _] = p;
        let pendulum = CompoundPendulum::new(m, i, a, g).unwrap();
        let (q, v) = pendulum.state_at(angle, rate);
        let expected = 0.5 * (i + m * a * a) * rate * rate - m * g * a * angle.cos();
        assert_abs_diff_eq!(energy(&pendulum, 0.0, &q, &v), expected, epsilon = 10.0 * ROUNDING);
        let other = pendulum.pseudo_holonomic();
        prop_assert!(other.holonomic(0.0, &q).is_none() && pendulum.holonomic(0.0, &q).is_some());
        prop_assert!(other.name() != pendulum.name());
    }
}

/// What the names promise.
#[test]
fn labels_and_standard_starts() {
    let particle = IsokineticParticle::new(1.0, 0.7, 0.5).unwrap();
    let (q, v) = particle.start();
    assert_abs_diff_eq!(particle.nonlinear(0.0, &q, &v).unwrap()[0].unwrap(), 0.0, epsilon = 1e-15);
    assert!(particle.labels().integrable && particle.name().contains("isokinetic") && !particle.source().is_empty());
    // Without a force it runs straight.
    let free = IsokineticParticle::new(1.0, 0.7, 0.0).unwrap();
    let (end, _) = free.exact(2.0).unwrap();
    let (q, v) = free.start();
    assert_eq!(end, [q[0] + 2.0 * v[0], q[1] + 2.0 * v[1]]);
}
