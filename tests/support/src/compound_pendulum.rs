use crate::{Model, ModelState};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// A rigid body in a vertical plane, hinged at the origin: a pendulum in the coordinates of a free body.
///
/// `q = (x, y, theta)`: the centre of mass (m), `y` upward, and the angle from hanging (rad). The hinge is two constraints on
/// positions, `x = a sin(theta)` and `y = -a cos(theta)`, or, pseudo-holonomic, the rates of these alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CompoundPendulum {
    mass: f64,
    inertia: f64,
    arm: f64,
    gravity: f64,
    positions: bool,
}

impl CompoundPendulum {
    /// A body of mass `m` (kg) and moment of inertia `I` about its centre of mass (kg m^2), which is `a` (m) from the hinge,
    /// under the gravity `g` (m/s^2), of either sign.
    pub fn new(mass: f64, inertia: f64, arm: f64, gravity: f64) -> Self {
        Self { mass, inertia, arm, gravity, positions: true }
    }

    /// The same with the hinge entered as constraints on velocities: the hinge may then be anywhere, and stays there.
    #[must_use]
    pub fn pseudo_holonomic(self) -> Self {
        Self { positions: false, ..self }
    }

    /// Where the hinge is (m): at the origin, but for a pseudo-holonomic one.
    pub fn hinge<S: Scalar>(&self, q: &[S; 3]) -> [S; 2] {
        let (sin, cos) = q[2].sin_cos();
        [q[0] - sin * self.arm, q[1] + cos * self.arm]
    }

    /// The state of the angle (rad) and its rate (rad/s).
    #[must_use]
    pub fn state_at(&self, angle: f64, rate: f64) -> ModelState<3> {
        let (sin, cos) = angle.sin_cos();
        let (x, y) = (self.arm * sin, -self.arm * cos);
        ([x, y, angle], [-y * rate, x * rate, rate])
    }
}

impl System<3, 2> for CompoundPendulum {
    /// `L = m/2 (x'^2 + y'^2) + I/2 theta'^2 - m g y`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass) + v[2] * v[2] * (0.5 * self.inertia)
            - q[1] * (self.mass * self.gravity)
    }

    /// `x' - a cos(theta) theta' = 0`, `y' - a sin(theta) theta' = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        let (sin, cos) = q[2].sin_cos();
        let (zero, one) = (S::zero(), S::constant(1.0));
        ([[one, zero, -cos * self.arm], [zero, one, -sin * self.arm]], [zero; 2])
    }

    /// `x - a sin(theta) = 0`, `y + a cos(theta) = 0`.
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<[Option<S>; 2]> {
        self.positions.then(|| self.hinge(q).map(Some))
    }

    /// The turn about the hinge.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 2>> {
        let (sin, cos) = q[2].sin_cos();
        Some(AdmissibleBasis::new([[cos * self.arm, sin * self.arm, S::constant(1.0)]]))
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

impl Model<3, 2> for CompoundPendulum {
    fn name(&self) -> &'static str {
        if self.positions { "compound pendulum" } else { "pseudo-holonomic pendulum" }
    }

    /// At rest but for a swing of 1.2 rad.
    fn start(&self) -> ModelState<3> {
        self.state_at(1.2, 0.3)
    }

    fn admissible(&self, q: [f64; 3], xi: [f64; 3]) -> ModelState<3> {
        let (hung, v) = self.state_at(q[2], xi[0]);
        if self.positions { (hung, v) } else { (q, v) }
    }
}
