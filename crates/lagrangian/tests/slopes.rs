//! Derivatives of constraints along a step.

use crate::common::{Everything, vector};
use approx::assert_relative_eq;
use lagrangian::{Constraint, Scalar, System, constraint_residual, residual_along};
use num_dual::Dual64;
use proptest::prelude::*;
use std::array::from_fn;

/// At a node whose place changes by a part of the change of the velocity, against num-dual.
fn check<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    (t, part): (f64, f64),
    q: &[f64; N],
    v: &[f64; N],
) {
    let found = residual_along(system, t, q, v, part);
    for i in 0..N {
        let along = |x: &[f64; N], by: f64| from_fn(|k| Dual64::new(x[k], if i == k { by } else { 0.0 }));
        let w: [Dual64; M] = constraint_residual(system, Dual64::from(t), &along(q, part), &along(v, 1.0));
        for k in 0..M {
            assert_relative_eq!(found[k].re, w[k].re, epsilon = 1e-13, max_relative = 1e-13);
            assert_relative_eq!(found[k].eps[i], w[k].eps, epsilon = 1e-12, max_relative = 1e-12);
        }
    }
}

/// Six coordinates: a row that moves, and one that is not affine.
struct Six;

impl System<6, 2> for Six {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 6], v: &[S; 6]) -> S {
        v.iter().fold(S::zero(), |sum, v| sum + *v * *v * 0.5)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 6]) -> Constraint<S, 6, 2> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        let row = [q[0] * q[5], one, (q[1] + t).sin(), zero, q[3] * 0.3, q[4] * q[2]];
        ([row, [zero; 6]], [(t * q[3]).cos(), zero])
    }
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; 6], v: &[S; 6]) -> Option<[Option<S>; 2]> {
        Some([None, Some(v[0] * v[0] * q[2] + v[4] * v[5] + t * v[3])])
    }
}

proptest! {
    #[test]
    fn of_constraints_along_a_step(
        c in vector(), t in -2.0..2.0f64, part in -1.0..1.0f64, q in vector::<3>(), v in vector::<3>(),
    ) {
        check(&Everything { c }, (t, part), &q, &v);
        let [q, v] = [[q, v], [v, q]].map(|parts| from_fn(|i| parts[i / 3][i % 3]));
        check(&Six, (t, part), &q, &v);
    }
}
