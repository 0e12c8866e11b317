//! Chaplygin's ball by three angles, `R = Rx(alpha) Ry(beta) Rz(gamma)`: coordinates that end where `cos(beta) = 0`.

use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// `q = (x, y, alpha, beta, gamma)`, with the mass, the radius and the principal moments of inertia.
#[derive(Debug, Clone, Copy)]
pub struct AngleBall {
    pub mass: f64,
    pub radius: f64,
    pub inertia: [f64; 3],
}

impl AngleBall {
    /// At the origin with the angles zero, rolling at the angular velocity `omega` (rad/s).
    pub fn level(&self, omega: [f64; 3]) -> ([f64; 5], [f64; 5]) {
        let r = self.radius;
        ([0.0; 5], [r * omega[1], -r * omega[0], omega[0], omega[1], omega[2]])
    }

    /// The rows that take the rates of the angles to the angular velocity in space along `x` and `y`.
    fn in_space<S: Scalar>(q: &[S; 5]) -> [[S; 3]; 2] {
        let ((sa, ca), (sb, cb)) = (q[2].sin_cos(), q[3].sin_cos());
        let (zero, one) = (S::zero(), S::constant(1.0));
        [[one, zero, sb], [zero, ca, -sa * cb]]
    }
}

impl System<5, 2> for AngleBall {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 5], v: &[S; 5]) -> S {
        let ((sb, cb), (sc, cc)) = (q[3].sin_cos(), q[4].sin_cos());
        let across = cb * v[2];
        let [o1, o2, o3] = [across * cc + v[3] * sc, v[3] * cc - across * sc, sb * v[2] + v[4]];
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass)
            + o1 * o1 * (0.5 * self.inertia[0])
            + o2 * o2 * (0.5 * self.inertia[1])
            + o3 * o3 * (0.5 * self.inertia[2])
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 5]) -> Constraint<S, 5, 2> {
        let [x, y] = Self::in_space(q);
        let (zero, one, r) = (S::zero(), S::constant(1.0), self.radius);
        ([[one, zero, -y[0] * r, -y[1] * r, -y[2] * r], [zero, one, x[0] * r, x[1] * r, x[2] * r]], [zero; 2])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 5]) -> Option<AdmissibleBasis<S, 5, 2>> {
        let [x, y] = Self::in_space(q);
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new(lagrangian::from_fn::<_, 3, _>(|k| {
            let mut w = [y[k] * self.radius, -x[k] * self.radius, zero, zero, zero];
            w[2 + k] = one;
            w
        })))
    }
    fn angles(&self) -> [bool; 5] {
        [false, false, true, true, true]
    }
}
