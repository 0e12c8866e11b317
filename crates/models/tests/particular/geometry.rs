//! The geometry behind the constraints.

use crate::ROUNDING;
use crate::common::{draws, parameters, state};
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
    #[test]
    fn kinematics_of_the_attitude(draws in draws()) {
        let angles: [f64; 3] = [3.0 * draws[0], 1.2 * draws[1], 3.0 * draws[2]];
        let rates: [f64; 3] = [draws[3], draws[4], draws[5]];
        let attitude = Attitude::new(angles);
        let r = attitude.rotation();
        let in_space = spin(&Attitude::new(moving(&angles, &rates)));
        let omega = attitude.body_velocity(rates);
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| r[i][k] * r[j][k]).sum();
                assert_abs_diff_eq!(product, if i == j { 1.0 } else { 0.0 }, epsilon = ROUNDING);
            }
            let from_body: f64 = (0..3).map(|k| r[i][k] * omega[k]).sum();
            let from_rates: f64 = (0..3).map(|k| attitude.space_velocity_matrix()[i][k] * rates[k]).sum();
            assert_abs_diff_eq!(from_body, in_space[i], epsilon = ROUNDING);
            assert_abs_diff_eq!(from_rates, in_space[i], epsilon = ROUNDING);
            assert_abs_diff_eq!(attitude.rates(omega)[i], rates[i], epsilon = ROUNDING);
        }
        // The orientation is right-handed.
        let volume = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1])
            - r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0])
            + r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
        assert_abs_diff_eq!(volume, 1.0, epsilon = ROUNDING);

        let second: [f64; 3] = [draws[6], draws[7], draws[8]];
        let turning = Attitude::new(moving(&angles, &rates)).body_velocity(moving(&rates, &second));
        let back = attitude.accelerations(rates, turning.map(|o| o.eps[0]));
        for i in 0..3 {
            assert_abs_diff_eq!(back[i], second[i], epsilon = ROUNDING);
        }
    }

    /// The point of the ball that touches the plane is at rest.
    #[test]
    fn the_ball_does_not_slip(p in parameters(), draws in draws()) {
        let ball = ChaplyginBall::new(p[0], p[1], [p[2], p[3], p[4]]).unwrap();
        let (q, v) = state(&ball, &draws);
        let [wx, wy, _] = spin(&Attitude::new(moving(&[q[2], q[3], q[4]], &[v[2], v[3], v[4]])));
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
