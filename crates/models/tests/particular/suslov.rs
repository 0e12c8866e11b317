//! The reduced Suslov problem.

use crate::common::{draws, parameters};
use crate::particular::ROUNDING;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use models::{Model, Suslov};
use proptest::prelude::*;
use std::array::from_fn;

proptest! {
    /// The closed form of the reduced Suslov problem solves its equations, is a flow, and keeps the energy.
    #[test]
    fn suslov_in_closed_form(p in parameters(), draws in draws()) {
        let [a, b, c, d, e] = p;
        let (i13, i23) = (c - d, d - e);
        let body = Suslov::new([a, b, c + i13 * i13 / a + i23 * i23 / b], i13, i23).unwrap();
        let start = [draws[0], draws[1]];
        let size = 1.0 + a / b + b / a;
        let t = 3.0 * draws[2];
        let here = body.exact_reduced(start, t);
        let slope = body.reduced_acceleration(here);
        // Richardson's extrapolation: an error of h^4 and a rounding over h.
        let central = |h: f64| {
            let (up, down) = (body.exact_reduced(start, t + h), body.exact_reduced(start, t - h));
            [(up[0] - down[0]) / (2.0 * h), (up[1] - down[1]) / (2.0 * h)]
        };
        let (wide, narrow) = (central(4e-4), central(2e-4));
        for i in 0..2 {
            assert_abs_diff_eq!((4.0 * narrow[i] - wide[i]) / 3.0, slope[i], epsilon = 1e-9 * size);
            assert_abs_diff_eq!(body.exact_reduced(start, 0.0)[i], start[i], epsilon = ROUNDING * size);
            // A flow; errors grow with exp(nu R t), below exp(20) here, on the way from the repeller.
            let two = body.exact_reduced(body.exact_reduced(start, 0.1 * t), 0.1 * t);
            assert_abs_diff_eq!(two[i], body.exact_reduced(start, 0.2 * t)[i], epsilon = 1e-10 * size);
        }
        let kinetic = |o: [f64; 2]| a * o[0] * o[0] + b * o[1] * o[1];
        assert_relative_eq!(kinetic(here), kinetic(start), max_relative = ROUNDING);
        // In the end a steady turn, in which I13 Omega1 + I23 Omega2 = 0.
        for far in [1e6, -1e6] {
            let [o1, o2] = body.exact_reduced(start, far);
            if (i13.abs() + i23.abs()) * kinetic(start).sqrt() > 1e-3 {
                assert_abs_diff_eq!(i13 * o1 + i23 * o2, 0.0, epsilon = ROUNDING * size);
            }
        }
    }
}

#[test]
fn the_steady_turn_of_suslov_forbids_a_measure() {
    let body = Suslov::new([1.0, 2.0, 1.5], 0.3, 0.5).unwrap();
    // I13 Omega1 + I23 Omega2 = 0 stays, and the trace is (I13/I22 + ..) of the reduced equations.
    let omega = [0.5, -0.3];
    assert_eq!(body.reduced_acceleration(omega), [0.0; 2]);
    let trace = -0.3 * omega[1] / 1.0 + 0.5 * omega[0] / 2.0;
    let slopes = |i: usize| {
        let shifted =
            |by: f64| body.reduced_acceleration(from_fn(|k| if k == i { omega[k] + by } else { omega[k] }))[i];
        shifted(0.5) - shifted(-0.5)
    };
    assert_relative_eq!(slopes(0) + slopes(1), trace, max_relative = 1e-14);
    assert!(trace.abs() > 0.1 && !body.labels().invariant_measure);
    assert!(Suslov::new([1.0, 2.0, 1.5], 0.0, 0.0).unwrap().labels().invariant_measure);
}
