//! The geometry behind the constraints.

use crate::common::{draws, parameters, state};
use crate::particular::ROUNDING;
use approx::assert_abs_diff_eq;
use lagrangian::{Dual, Scalar};
use models::{Attitude, ChaplyginBall, RollerRacer, Snakeboard};
use proptest::prelude::*;
use std::array::from_fn;

/// Values that move at given rates.
pub(crate) fn moving<const N: usize>(q: &[f64; N], rates: &[f64; N]) -> [Dual<f64, 1>; N] {
    from_fn(|i| Dual { re: q[i], eps: [rates[i]] })
}

/// The angular velocity `w` of `R' = (w x) R`, in space.
pub(crate) fn spin(attitude: &Attitude<Dual<f64, 1>>) -> [f64; 3] {
    let r = attitude.rotation();
    let entry = |i: usize, j: usize| (0..3).map(|k| r[i][k].eps[0] * r[j][k].re).sum::<f64>();
    [entry(2, 1), entry(0, 2), entry(1, 0)]
}

proptest! {
    /// The matrix is a rotation, and moves as the angular velocities say; rates and second derivatives are found back.
    #[test]
    fn kinematics_of_the_attitude(draws in draws()) {
        let attitude = Attitude::nearest([draws[0], draws[1], draws[2], draws[3]]);
        let (e, r) = (attitude.quaternion(), attitude.rotation());
        let omega: [f64; 3] = [3.0 * draws[4], 3.0 * draws[5], 3.0 * draws[6]];
        let rates = attitude.rates_of_body(&omega);
        let turning = Attitude::new(moving(&e, &rates));
        let in_space = spin(&turning);
        let close = |a: &[f64], b: &[f64]| assert_abs_diff_eq!(a, b, epsilon = ROUNDING);
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| r[i][k] * r[j][k]).sum();
                assert_abs_diff_eq!(product, if i == j { 1.0 } else { 0.0 }, epsilon = ROUNDING);
            }
        }
        // The orientation is right-handed.
        let volume = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1])
            - r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0])
            + r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
        assert_abs_diff_eq!(volume, 1.0, epsilon = ROUNDING);
        close(&attitude.in_space(&omega), &in_space);
        close(&attitude.in_body(&in_space), &omega);
        close(&attitude.space_velocity(&rates), &in_space);
        close(&attitude.body_velocity(&rates), &omega);
        close(&attitude.rates_of_space(&in_space), &rates);
        for (row, (fast, slow)) in attitude.body_velocity_matrix().iter().zip(attitude.body_turns().iter().zip(omega)) {
            assert_abs_diff_eq!((0..4).map(|i| row[i] * rates[i]).sum::<f64>(), slow, epsilon = ROUNDING);
            // Two rad/s of rate one half each: the rows and the turns are inverse to one another.
            assert_abs_diff_eq!((0..4).map(|i| row[i] * fast[i]).sum::<f64>(), 1.0, epsilon = ROUNDING);
        }
        // The length stays, and its row is its rate.
        let miss = turning.norm_miss();
        assert_abs_diff_eq!(miss.re, 0.0, epsilon = ROUNDING);
        assert_abs_diff_eq!(miss.eps[0], 0.0, epsilon = ROUNDING);
        let off = Attitude::new(moving(&e.map(|e| 1.5 * e), &[1.0, -2.0, 0.5, 0.3])).norm_miss();
        assert_abs_diff_eq!(off.re, 0.625, epsilon = ROUNDING);
        let row = Attitude::new(e.map(|e| 1.5 * e)).norm_row();
        assert_abs_diff_eq!(off.eps[0], row[0] - 2.0 * row[1] + 0.5 * row[2] + 0.3 * row[3], epsilon = ROUNDING);

        // Angular accelerations, from any second derivatives that keep the length: `e . e'' + |e'|^2 = 0`.
        let any: [f64; 4] = from_fn(|i| 2.0 * draws[7 + i]);
        let along: f64 = (0..4).map(|i| e[i] * any[i] + rates[i] * rates[i]).sum();
        let second: [f64; 4] = from_fn(|i| any[i] - along * e[i]);
        let moving_rates = moving(&rates, &second);
        let body = turning.body_velocity(&moving_rates).map(|o| o.eps[0]);
        let space = turning.space_velocity(&moving_rates).map(|o| o.eps[0]);
        for back in [attitude.accelerations_of_body(&rates, &body), attitude.accelerations_of_space(&rates, &space)] {
            assert_abs_diff_eq!(&back[..], &second[..], epsilon = 10.0 * ROUNDING);
        }
        // The energy is that of the principal moments, on the constraint.
        let moments = [0.7, 1.1, 1.6];
        let expected = (0..3).map(|i| 0.5 * moments[i] * omega[i] * omega[i]).sum::<f64>();
        let energy = Attitude::turning_energy(&rates, &attitude.body_velocity(&rates), moments);
        assert_abs_diff_eq!(energy, expected, epsilon = 10.0 * ROUNDING);
    }

    /// By three angles, `Rx(alpha) Ry(beta) Rz(gamma)`, written out: another chart of the same attitudes.
    #[test]
    fn quaternions_and_angles(draws in draws()) {
        let [alpha, beta, gamma] = [3.0 * draws[0], 1.2 * draws[1], 3.0 * draws[2]];
        let about = |k: usize, angle: f64| Attitude::about(from_fn(|i| if i == k { 2.5 } else { 0.0 }), angle);
        let r = about(0, alpha).after(&about(1, beta).after(&about(2, gamma))).rotation();
        let ((sa, ca), (sb, cb), (sc, cc)) = (alpha.sin_cos(), beta.sin_cos(), gamma.sin_cos());
        let expected = [
            [cb * cc, -cb * sc, sb],
            [ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb],
            [sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb],
        ];
        for (ours, row) in r.iter().zip(expected) {
            assert_abs_diff_eq!(&ours[..], &row[..], epsilon = ROUNDING);
        }
    }

    /// The point of the ball that touches the plane is at rest.
    #[test]
    fn the_ball_does_not_slip(p in parameters(), draws in draws()) {
        let ball = ChaplyginBall::new(p[0], p[1], [p[2], p[3], p[4]]).unwrap();
        let (q, v) = state(&ball, &draws);
        let [wx, wy, _] = spin(&Attitude::new(moving(&[q[2], q[3], q[4], q[5]], &[v[2], v[3], v[4], v[5]])));
        // V + w x (0, 0, -r).
        assert_abs_diff_eq!(v[0] - wy * ball.radius(), 0.0, epsilon = ROUNDING);
        assert_abs_diff_eq!(v[1] + wx * ball.radius(), 0.0, epsilon = ROUNDING);
    }

    /// Each axle of the snakeboard moves along its wheels.
    #[test]
    fn the_axles_of_the_board_do_not_slip(p in parameters(), draws in draws()) {
        let board = Snakeboard::new(p[0], p[1], p[2], p[3], p[4]).unwrap();
        let (q, v) = state(&board, &draws);
        let [x, y, theta, _, phi] = moving(&q, &v);
        let (sin, cos) = theta.sin_cos();
        for (side, wheels) in [(-1.0, theta + phi), (1.0, theta - phi)] {
            let at = [x + cos * (side * board.length()), y + sin * (side * board.length())];
            let (sin, cos) = wheels.re.sin_cos();
            assert_abs_diff_eq!(cos * at[1].eps[0] - sin * at[0].eps[0], 0.0, epsilon = ROUNDING);
        }
    }

    /// Each axle of the roller racer moves along its wheels.
    #[test]
    fn the_axles_of_the_racer_do_not_slip(p in parameters(), draws in draws()) {
        let racer = RollerRacer::new(p[0], p[1], p[2], p[3], p[4]).unwrap();
        let (q, v) = state(&racer, &draws);
        let [x, y, theta, phi] = moving(&q, &v);
        let [d1, d2] = racer.distances();
        let ((sin, cos), (front_sin, front_cos)) = (theta.sin_cos(), (theta + phi).sin_cos());
        let front = [x + cos * d1 + front_cos * d2, y + sin * d1 + front_sin * d2];
        let across = |at: [f64; 2], heading: f64| heading.cos() * at[1] - heading.sin() * at[0];
        assert_abs_diff_eq!(across([v[0], v[1]], q[2]), 0.0, epsilon = ROUNDING);
        // The hinge's rate divides by d2, up to 20.
        assert_abs_diff_eq!(across(front.map(|f| f.eps[0]), q[2] + q[3]), 0.0, epsilon = 10.0 * ROUNDING);
    }
}

/// What makes a start: an attitude from any numbers, and no turn about no axis.
#[test]
fn attitudes_of_any_numbers() {
    let level = Attitude::LEVEL;
    assert_eq!(level.rotation(), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    for none in [[0.0; 4], [f64::NAN; 4], [f64::INFINITY, 0.0, 0.0, 1.0], [1.0, f64::NAN, 0.0, 0.0]] {
        assert_eq!(Attitude::nearest(none), level);
    }
    for size in [1e-300, 1.0, 1e300] {
        let [s, x, y, z] = Attitude::nearest([3.0 * size, 0.0, -4.0 * size, 0.0]).quaternion();
        assert_abs_diff_eq!(&[s, x, y, z][..], &[0.6, 0.0, -0.8, 0.0][..], epsilon = 1e-15);
    }
    assert_eq!(Attitude::about([0.0; 3], 1.0), level);
    assert_eq!(Attitude::about([f64::NAN, 0.0, 0.0], 1.0), level);
    // A quarter turn about z takes x to y.
    let quarter = Attitude::about([0.0, 0.0, 7.0], std::f64::consts::FRAC_PI_2);
    assert_abs_diff_eq!(&quarter.in_space(&[1.0, 0.0, 0.0])[..], &[0.0, 1.0, 0.0][..], epsilon = 1e-15);
}
