//! Derivatives that are known in closed form.

use crate::sensitivity::systems::Controlled;
use crate::support::ByHand;
use dla::{Dla, Form, Sensitivity, State};
use lagrangian::{Constraint, Scalar, System};
use sleigh::{Sleigh, SleighState};

/// About straight motion at the speed `U` a spin is multiplied by `(1 - h c U/2)/(1 + h c U/2)`, `c = m a/J`, a speed by 1.
#[test]
fn the_multiplier_of_the_spin_at_straight_motion() {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let system = ByHand::from(sleigh);
    for (speed, h) in [(1.0, 0.1), (-1.5, 0.05), (2.0, 0.4)] {
        let start = SleighState { speed, heading: 0.7, ..SleighState::default() };
        for form in [Form::Best, Form::Multipliers] {
            let (q, v) = start.to_coordinates();
            let mut state = State::new(q, v, [false, false, true]);
            let mut method = Dla::midpoint().solved(form);
            let derivative = Sensitivity::of(&system).step(&mut method, 0.0, h, &mut state).unwrap();
            let matrix = derivative.reduced.unwrap().matrix();
            let half = 0.5 * h * sleigh.spin_gain() * speed;
            // Rows and columns are (x, y, theta, u, omega); u and omega do not depend on the place.
            let expected = [[1.0, 0.0], [0.0, (1.0 - half) / (1.0 + half)]];
            for i in 0..2 {
                for j in 0..3 {
                    approx::assert_abs_diff_eq!(matrix[3 + i][j], 0.0, epsilon = 1e-12);
                }
                for j in 0..2 {
                    approx::assert_abs_diff_eq!(matrix[3 + i][3 + j], expected[i][j], epsilon = 1e-12);
                }
            }
            // The way along the blade.
            approx::assert_abs_diff_eq!(matrix[0][3], h * 0.7f64.cos(), epsilon = 1e-12);
        }
    }
}

/// Of the free sleigh the end of a step does not depend on the place; in the egg crate it does.
#[test]
fn what_vanishes_and_what_does_not() {
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.4, ..SleighState::default() }.to_coordinates();
    let speeds_in_x = |height: f64| {
        let system = Controlled::at(&[1.3, 0.8, 0.4, height, 0.0, 0.0]);
        let mut state = State::new([0.9, 0.4, q[2]], v, [false, false, true]);
        let derivative = Sensitivity::of_member(&system).step(&mut Dla::midpoint(), 0.0, 0.1, &mut state).unwrap();
        let reduced = derivative.reduced.unwrap();
        (reduced.from_q[0].xi, reduced.from_parameters[4].xi)
    };
    let (free, thrust) = speeds_in_x(0.0);
    assert!(free.iter().all(|x| x.abs() < 1e-15), "{free:?}");
    let (crate_, _) = speeds_in_x(0.7);
    assert!(crate_[0].abs() > 1e-2, "{crate_:?}");
    // A thrust for the time h gives the speed h/m, times its swing in the middle of the step, but for the turning of the blade.
    let swing = 1.0 + 0.5 * (2.0 * 0.05f64).sin();
    approx::assert_relative_eq!(thrust[0], swing * 0.1 / 1.3, max_relative = 0.1f64.powi(2));
}

/// A unit mass on a stiff spring about a place far away. Places there are rounded to 1e-4 m, and the force of the spring to 1 N.
struct FarSpring;

impl FarSpring {
    const PLACE: f64 = 1e12;
    /// (N/m)
    const STIFFNESS: f64 = 1e4;
}

impl System<1, 0> for FarSpring {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 1], v: &[S; 1]) -> S {
        let stretch = q[0] - Self::PLACE;
        (v[0] * v[0] - stretch * stretch * Self::STIFFNESS) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 0> {
        ([], [])
    }
}

/// Corrections of Newton's method that go to and fro by the rounding of a large force end the search: the step has its derivative.
#[test]
fn corrections_that_are_rounding_end_the_search() {
    let h = 0.1;
    // The midpoint rule is a linear map: with `c = k h^2/4` it takes `(x, v)` to `((1 - c) x + h v, (1 - c) v - k h x)/(1 + c)`.
    let c = 0.25 * h * h * FarSpring::STIFFNESS;
    let [stays, moves] = [(1.0 - c) / (1.0 + c), h / (1.0 + c)];
    for i in 0..20 {
        let (x, v) = (0.3 + 0.071 * f64::from(i), 1.0 - 0.13 * f64::from(i));
        let mut state = State::new([FarSpring::PLACE + x], [v], [false]);
        let derivative = Sensitivity::of(&FarSpring).step(&mut Dla::midpoint(), 0.0, h, &mut state).unwrap();
        let [from_q, from_v] = [derivative.from_q[0], derivative.from_v[0]];
        let exact = [stays, -FarSpring::STIFFNESS * moves, moves, stays];
        for (found, exact) in [from_q.q, from_q.v, from_v.q, from_v.v].into_iter().zip(exact) {
            approx::assert_relative_eq!(found[0], exact, max_relative = 1e-12);
        }
    }
}
