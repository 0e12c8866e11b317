use crate::Sleigh;
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// The same sleigh in the coordinates `(X, Y, theta)` of its centre of mass.
///
/// There the mass matrix is constant and diagonal, and so is `A M^-1 A'`: the trapezoidal method then keeps the energy of
/// the free sleigh to round-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CentreOfMass(pub Sleigh);

impl CentreOfMass {
    /// Coordinates and velocities at the centre of mass, of those at the blade.
    #[must_use]
    pub fn from_blade(&self, q: &[f64; 3], v: &[f64; 3]) -> ([f64; 3], [f64; 3]) {
        self.moved(q, v, self.0.offset())
    }

    /// Coordinates and velocities at the blade, of those at the centre of mass.
    #[must_use]
    pub fn to_blade(&self, q: &[f64; 3], v: &[f64; 3]) -> ([f64; 3], [f64; 3]) {
        self.moved(q, v, -self.0.offset())
    }

    /// The point at the distance `d` ahead along the blade: `P + d e`, `P' + d omega n`.
    fn moved(&self, q: &[f64; 3], v: &[f64; 3], d: f64) -> ([f64; 3], [f64; 3]) {
        let (sin, cos) = Scalar::sin_cos(q[2]);
        let spin = d * v[2];
        ([q[0] + d * cos, q[1] + d * sin, q[2]], [v[0] - spin * sin, v[1] + spin * cos, v[2]])
    }
}

impl System<3, 1> for CentreOfMass {
    /// `L = m/2 |C'|^2 + I/2 omega^2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.0.mass()) + v[2] * v[2] * (0.5 * self.0.inertia())
    }

    /// The blade, the distance `a` behind, does not slip: `n . C' - a omega = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        ([[-sin, cos, S::constant(-self.0.offset())]], [S::zero()])
    }

    /// Drive along the blade, and pivot about it.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (sin, cos) = q[2].sin_cos();
        let a = self.0.offset();
        Some(AdmissibleBasis::new([[cos, sin, S::zero()], [-(sin * a), cos * a, S::constant(1.0)]]))
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}
