use crate::error::{finite, positive};
use crate::special::{sinc, sine_defect};
use crate::{Labels, Model, ModelError, ModelState};
use lagrangian::{Scalar, energy};

/// A knife edge on an incline: a body whose centre of mass stands over its blade, on a slope that falls along `x`.
///
/// `q = (x, y, theta)`: the blade's contact point (m) and the heading (rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnifeEdge {
    mass: f64,
    inertia: f64,
    pull: f64,
}

impl KnifeEdge {
    /// A body of mass `m` (kg) and moment of inertia `I` about the blade (kg m^2), gravity's part down the slope being
    /// `g` (m/s^2), of either sign.
    ///
    /// # Errors
    /// [`ModelError`] names the parameter that is not positive, or not finite.
    pub fn new(mass: f64, inertia: f64, pull: f64) -> Result<Self, ModelError> {
        Ok(Self {
            mass: positive("mass", mass)?,
            inertia: positive("moment of inertia", inertia)?,
            pull: finite("gravity along the slope", pull)?,
        })
    }

    /// Mass `m` (kg).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Moment of inertia `I` (kg m^2).
    #[must_use]
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Gravity's part `g` down the slope (m/s^2).
    #[must_use]
    pub fn pull(&self) -> f64 {
        self.pull
    }

    /// The momentum of the turn, `I theta'` (kg m^2/s).
    pub fn turn_momentum<S: Scalar>(&self, v: &[S; 3]) -> S {
        v[2] * self.inertia
    }

    /// `u theta' - g sin(theta)` (m/s^2), with `u` the speed along the blade.
    pub fn hodograph<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> S {
        let (sin, cos) = q[2].sin_cos();
        (cos * v[0] + sin * v[1]) * v[2] - sin * self.pull
    }
}

macros::system! { lagrangian;
    impl KnifeEdge;
    coordinates = { x = "m", y = "m", theta = "angle" }
    parameters = { m = self.mass, I = self.inertia, g = self.pull }
    lagrangian = "m/2*(x'^2 + y'^2) + I/2*theta'^2 + m*g*x"
    constraints = ["y'*cos(theta) - x'*sin(theta)"]
    // Drive along the blade, and pivot about it.
    basis = [["cos(theta)", "sin(theta)", "0"], ["0", "0", "1"]]
}

impl Model<3, 1> for KnifeEdge {
    fn name(&self) -> &'static str {
        "knife edge on an incline"
    }

    fn source(&self) -> &'static str {
        "Neimark and Fufaev 1972, Dynamics of Nonholonomic Systems; Bloch 2015, Nonholonomic Mechanics and Control, \
         section 1.6"
    }

    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: true, invariant_measure: true }
    }

    /// At rest but for a turn at 1 rad/s, the blade across the slope's contours: its path is a cycloid.
    fn start(&self) -> ModelState<3> {
        ([0.0; 3], [0.0, 0.0, 1.0])
    }

    /// `u' = g cos(theta)`, `theta'' = 0`.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        let (sin, cos) = q[2].sin_cos();
        let along = self.pull * cos;
        let across = (cos * v[0] + sin * v[1]) * v[2];
        [along * cos - across * sin, along * sin + across * cos, 0.0]
    }

    fn invariants<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> Vec<(&'static str, S)> {
        vec![
            ("energy", energy(self, S::zero(), q, v)),
            ("turn momentum", self.turn_momentum(v)),
            ("hodograph", self.hodograph(q, v)),
        ]
    }

    fn density<S: Scalar>(&self, _q: &[S; 3]) -> Option<S> {
        Some(S::constant(1.0))
    }

    /// With `w = theta'`, `c = (sin theta - sin theta0)/w` and `s = -(cos theta - cos theta0)/w`: `u = u0 + g c`,
    /// `x = x0 + u0 c + g c^2/2`, `y = y0 + u0 s + g/w int (sin theta - sin theta0) sin theta dt`, in a form that holds
    /// down to `w = 0`.
    fn exact_from(&self, (q, v): &ModelState<3>, t: f64) -> Option<ModelState<3>> {
        let (sin0, cos0) = q[2].sin_cos();
        let u0 = cos0 * v[0] + sin0 * v[1];
        let z = v[2] * t;
        let theta = q[2] + z;
        let (sin_mean, cos_mean) = (q[2] + 0.5 * z).sin_cos();
        let mean = sinc(0.5 * z);
        let (c, s) = (t * mean * cos_mean, t * mean * sin_mean);
        let u = u0 + self.pull * c;
        let drift = t * t * (sine_defect(z) + 0.5 * mean * mean * sin_mean * cos_mean);
        let end = [q[0] + u0 * c + 0.5 * self.pull * c * c, q[1] + u0 * s + self.pull * drift, theta];
        let (sin, cos) = theta.sin_cos();
        Some((end, [u * cos, u * sin, v[2]]))
    }
}
