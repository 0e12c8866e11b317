use crate::{Model, ModelState};
use lagrangian::{Constraint, Scalar, System};

/// A particle in the plane under a constant force along `x`, whose speed is held: `|v|^2 = c^2`, a constraint that is not
/// affine in the velocities, with its reaction along `v` (Chetaev). This is the isokinetic thermostat of one particle.
///
/// `q = (x, y)` (m). The direction turns toward the force, `phi' = -F/(m c) sin(phi)`, and the energy is not kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsokineticParticle {
    mass: f64,
    speed: f64,
    force: f64,
}

impl IsokineticParticle {
    /// A particle of mass `m` (kg) held at the speed `c` (m/s) under the force `F` (N), of either sign.
    pub fn new(mass: f64, speed: f64, force: f64) -> Self {
        Self { mass, speed, force }
    }

    /// The state at a place (m) in a direction (rad).
    #[must_use]
    pub fn state_at(&self, q: [f64; 2], direction: f64) -> ModelState<2> {
        (q, [self.speed * direction.cos(), self.speed * direction.sin()])
    }
}

impl System<2, 1> for IsokineticParticle {
    /// `L = m/2 |v|^2 + F x`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass) + q[0] * self.force
    }

    /// None that is affine.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(); 2]], [S::zero()])
    }

    /// `(|v|^2 - c^2)/(2 c) = 0`.
    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> Option<[Option<S>; 1]> {
        Some([Some((v[0] * v[0] + v[1] * v[1] - self.speed * self.speed) / (2.0 * self.speed))])
    }
}

impl Model<2, 1> for IsokineticParticle {
    fn name(&self) -> &'static str {
        "isokinetic particle"
    }

    fn start(&self) -> ModelState<2> {
        self.state_at([0.2, -0.1], 2.4)
    }

    /// In the direction of `xi`.
    fn admissible(&self, q: [f64; 2], xi: [f64; 2]) -> ModelState<2> {
        self.state_at(q, xi[1].atan2(xi[0]))
    }

    /// With `s = F/(m c)`, `A = cos(phi0/2) exp(s t/2)` and `B = sin(phi0/2) exp(-s t/2)`: `tan(phi/2) = B/A`,
    /// `x = x0 + c/s ln(A^2 + B^2)`, `y = y0 + c/s (phi0 - phi)`.
    fn exact_from(&self, (q, v): &ModelState<2>, t: f64) -> Option<ModelState<2>> {
        let c = self.speed;
        let s = self.force / (self.mass * c);
        if s == 0.0 {
            return Some(([q[0] + t * v[0], q[1] + t * v[1]], *v));
        }
        let phi0 = v[1].atan2(v[0]);
        let (sin, cos) = (0.5 * phi0).sin_cos();
        let grown = (0.5 * s * t).exp();
        let (a, b) = (cos * grown, sin / grown);
        let square = a * a + b * b;
        let phi = 2.0 * b.atan2(a);
        Some((
            [q[0] + c / s * square.ln(), q[1] + c / s * (phi0 - phi)],
            [c * (a * a - b * b) / square, c * 2.0 * a * b / square],
        ))
    }
}
