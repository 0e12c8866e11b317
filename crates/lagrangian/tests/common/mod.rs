//! A system that has everything: a mass matrix that depends on the configuration, terms linear in the velocity,
//! explicit time, a force, and an affine constraint that moves.

use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use proptest::prelude::*;

#[derive(Debug, Clone, Copy)]
pub struct Everything {
    pub c: [f64; 6],
}

impl System<3, 1> for Everything {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let c = &self.c;
        let (sin, cos) = (q[2] + t * c[0]).sin_cos();
        let inertia = (q[0] * q[0] + 1.0).sqrt() * (2.0 + c[1] * c[1]);
        v[0] * v[0] * 0.5
            + v[1] * v[1] * (0.5 + 0.1 * c[2] * c[2])
            + v[2] * v[2] * 0.5 * inertia
            + v[0] * v[2] * cos * 0.3
            + v[1] * sin * c[3]
            - (q[1] * 0.3).exp() * c[4]
            - (q[0].squared() + 2.0).ln() / ((t * 0.5).cos() + 3.0)
            - (q[1].powi(3) + q[0]) * c[5]
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        ([[-sin, cos, q[0] * 0.2 + t * 0.1]], [(t * self.c[0]).sin() * 0.3 + q[1] * 0.1])
    }
    fn force<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([-v[0] * self.c[1] * self.c[1], (t + q[0]).sin() * 0.4, -(v[2] * v[0]) * 0.2])
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (sin, cos) = q[2].sin_cos();
        let third = q[0] * 0.2 + t * 0.1;
        Some(AdmissibleBasis::new([[cos, sin, S::zero()], [sin * third, -(cos * third), S::constant(1.0)]]))
    }
}

/// Random parameters and states: ordinary ones, and nearly equal, tiny and large components among them.
pub fn component() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -2.0..2.0, 1 => Just(0.0), 1 => -1e-9..1e-9, 1 => (-1.0..1.0f64).prop_map(|x| 1.0 + 1e-12 * x)]
}

pub fn vector<const K: usize>() -> impl Strategy<Value = [f64; K]> {
    proptest::array::uniform(component())
}
