//! Motions that forbid an invariant measure.

use crate::common::parameters;
use crate::particular::ROUNDING;
use approx::assert_abs_diff_eq;
use lagrangian::{Dual, System, reduced_acceleration};
use models::{Model, RollerRacer};
use proptest::prelude::*;
use std::array::from_fn;

/// The divergence of the reduced equations `q' = W xi`, `xi' = g` at one point; a central difference is exact for the
/// quadratic `g`.
fn divergence<Mo: Model<N, M>, const N: usize, const M: usize>(model: &Mo, q: &[f64; N], xi: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for j in 0..N {
        let seeded: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [if i == j { 1.0 } else { 0.0 }] });
        let basis = model.admissible_basis(Dual::fixed(0.0), &seeded).unwrap();
        sum += basis.combine(&xi.map(Dual::fixed))[j].eps[0];
    }
    for j in 0..N - M {
        let shifted = |by: f64| {
            let xi = from_fn(|i| if i == j { xi[i] + by } else { xi[i] });
            reduced_acceleration(model, 0.0, q, &xi).unwrap()[j]
        };
        sum += shifted(0.5) - shifted(-0.5);
    }
    sum
}

proptest! {
    /// Where all but cyclic coordinates rest, a smooth measure needs a divergence of zero. Straight ahead it is
    /// `u/d2 (1 - g)/(1 + g d1/d2)` with `g = I2 d1/(I1 d2)`, and folded, at `phi = pi`, `-u/d2 (1 + g)/(1 + g d1/d2)`.
    #[test]
    fn straight_motions_of_the_racer_forbid_a_measure(p in parameters(), u in 0.5..1.5f64) {
        let [mass, rear, front, d1, d2] = p;
        let racer = RollerRacer::new(mass, rear, front, d1, d2).unwrap();
        let gain = front * d1 / (rear * d2);
        for (phi, sign) in [(0.0, 1.0), (std::f64::consts::PI, -1.0)] {
            let (q, xi) = ([0.0, 0.0, 0.0, phi], [u, 0.0, 0.0, 0.0]);
            let v = racer.admissible_basis(0.0, &q).unwrap().combine(&xi);
            let expected = sign * u / d2 * (1.0 - sign * gain) / (1.0 + gain * d1 / d2);
            // The terms add up to at most some 200, before they cancel.
            for a in racer.accelerations_by_hand(0.0, &q, &v) {
                assert_abs_diff_eq!(a, 0.0, epsilon = 100.0 * ROUNDING);
            }
            assert_abs_diff_eq!(divergence(&racer, &q, &xi), expected, epsilon = 100.0 * ROUNDING);
            assert!(sign > 0.0 || expected < -0.01);
        }
        assert!(!racer.labels().invariant_measure);
    }
}
