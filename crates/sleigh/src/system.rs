use crate::Sleigh;
use lagrangian::{AdmissibleBasis, Constraint, Motion, Reduced, ReducedError, Scalar, System};

impl System<3, 1> for Sleigh {
    /// `L = m/2 |P'|^2 + m a omega (n . P') + J/2 omega^2`, which is `m/2 |C'|^2 + I/2 omega^2` written at the blade.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let (sin, cos) = q[2].sin_cos();
        let across = cos * v[1] - sin * v[0];
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass())
            + v[2] * across * (self.mass() * self.offset())
            + v[2] * v[2] * (0.5 * self.pivot_inertia())
    }

    /// The blade does not slip: `n . P' = -sin(theta) x' + cos(theta) y' = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        ([[-sin, cos, S::zero()]], [S::zero()])
    }

    /// Drive along the blade, and pivot about it.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (sin, cos) = q[2].sin_cos();
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[cos, sin, zero], [zero, zero, one]]))
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }

    #[inline(always)]
    fn reduced(&self) -> impl Reduced<3, 1> {
        self
    }
}

impl Reduced<3, 1> for Sleigh {
    /// With `s = n . P'` the slip and `u = e . P'`,
    /// `u' = a omega^2 + s omega`, `omega' = -(m a / J) u omega`, `s' = 0`, `lambda = (m I / J) u omega`.
    #[inline]
    fn motion(&self, _t: f64, q: &[f64; 3], v: &[f64; 3]) -> Option<Motion<3, 1>> {
        let a = self.offset();
        let (sin, cos) = q[2].sin_cos();
        let omega = v[2];
        let u = cos * v[0] + sin * v[1];
        // P'' = (u' - omega s) e + (s' + omega u) n, and u' - omega s = a omega^2.
        let (along, across) = (a * omega * omega, u * omega);
        Some(Motion {
            acceleration: [along * cos - across * sin, along * sin + across * cos, -self.spin_gain() * across],
            multiplier: [self.mass() * across * (self.inertia() / self.pivot_inertia())],
        })
    }

    /// `u' = (e . f) / m`, `omega' = tau / J` of a force `f` at the blade and a torque `tau`. Across the blade the constraint takes the
    /// force less the part that turns the mass, `lambda = m a omega' - n . f`.
    #[inline]
    fn response(&self, _t: f64, q: &[f64; 3], &[fx, fy, tau]: &[f64; 3]) -> Option<Motion<3, 1>> {
        let (sin, cos) = q[2].sin_cos();
        let (along, turn) = ((cos * fx + sin * fy) / self.mass(), tau / self.pivot_inertia());
        let across = cos * fy - sin * fx;
        Some(Motion {
            acceleration: [along * cos, along * sin, turn],
            multiplier: [self.mass() * self.offset() * turn - across],
        })
    }

    /// `u' = a omega^2`, `omega' = -(m a / J) u omega`.
    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, _t: S, _q: &[S; 3], &[u, omega, _]: &[S; 3]) -> Option<[S; 3]> {
        Some([omega * omega * self.offset(), u * omega * -self.spin_gain(), S::zero()])
    }

    /// `u e`, and `omega`.
    #[inline(always)]
    fn velocity<S: Scalar>(
        &self,
        _t: S,
        q: &[S; 3],
        &[u, omega, _]: &[S; 3],
        _derived: impl FnOnce() -> Result<[S; 3], ReducedError>,
    ) -> Result<[S; 3], ReducedError> {
        let (sin, cos) = q[2].sin_cos();
        Ok([cos * u, sin * u, omega])
    }

    /// The heading from the spin, and the place from the heading.
    #[inline(always)]
    fn reconstruction(&self) -> Option<u32> {
        Some(1)
    }

    #[inline(always)]
    fn stands_alone(&self) -> bool {
        true
    }

    /// `u' = a omega^2 + (e . f) / m`, `omega' = -(m a / J) u omega + tau / J`.
    #[inline(always)]
    fn pushed_motion<S: Scalar>(&self, t: S, q: &[S; 3], xi: &[S; 3], &[fx, fy, tau]: &[S; 3]) -> Option<[S; 3]> {
        let [along, turn, none] = self.reduced_motion(t, q, xi)?;
        let (sin, cos) = q[2].sin_cos();
        let [per_mass, per_inertia] = self.inverse();
        Some([along + (cos * fx + sin * fy) * per_mass, turn + tau * per_inertia, none])
    }
}
