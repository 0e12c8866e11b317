use crate::error::{finite, positive};
use crate::{Labels, Model, ModelError, ModelState};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, energy};

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
    ///
    /// # Errors
    /// [`ModelError`] names the parameter that is not positive, or not finite.
    pub fn new(mass: f64, inertia: f64, arm: f64, gravity: f64) -> Result<Self, ModelError> {
        Ok(Self {
            mass: positive("mass", mass)?,
            inertia: positive("moment of inertia", inertia)?,
            arm: positive("distance of the centre of mass from the hinge", arm)?,
            gravity: finite("gravity", gravity)?,
            positions: true,
        })
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

    fn source(&self) -> &'static str {
        "Huygens 1673; as a pseudo-holonomic system: McLachlan and Perlmutter 2006, J. Nonlinear Sci. 16, 283-328"
    }

    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: true, invariant_measure: true }
    }

    /// At rest but for a swing of 1.2 rad.
    fn start(&self) -> ModelState<3> {
        self.state_at(1.2, 0.3)
    }

    fn admissible(&self, q: [f64; 3], xi: [f64; 3]) -> ModelState<3> {
        let (hung, v) = self.state_at(q[2], xi[0]);
        if self.positions { (hung, v) } else { (q, v) }
    }

    /// `(I + m a^2) theta'' = -m g a sin(theta)`.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        let (a, (sin, cos)) = (self.arm, q[2].sin_cos());
        let turn = -self.mass * self.gravity * a * sin / (self.inertia + self.mass * a * a);
        let pull = v[2] * v[2];
        [a * (cos * turn - sin * pull), a * (sin * turn + cos * pull), turn]
    }

    fn invariants<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> Vec<(&'static str, S)> {
        let [x, y] = self.hinge(q);
        vec![("energy", energy(self, S::zero(), q, v)), ("hinge, x", x), ("hinge, y", y)]
    }

    fn density<S: Scalar>(&self, _q: &[S; 3]) -> Option<S> {
        Some(S::constant(1.0))
    }
}
