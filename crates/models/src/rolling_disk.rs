use crate::error::positive;
use crate::special::sinc;
use crate::{Labels, Model, ModelError, ModelState};
use lagrangian::{Scalar, energy};

/// A disk that stays upright and rolls without slipping on a horizontal plane.
///
/// `q = (x, y, phi, theta)`: the contact point (m), the spin about the disk's axle (rad), and the heading (rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingDisk {
    mass: f64,
    radius: f64,
    spin_inertia: f64,
    heading_inertia: f64,
}

impl RollingDisk {
    /// A disk of mass `m` (kg) and radius `R` (m), with the moments of inertia `I` about its axle and `J` about its
    /// vertical diameter (kg m^2).
    ///
    /// # Errors
    /// [`ModelError`] names the parameter that is not positive.
    pub fn new(mass: f64, radius: f64, spin_inertia: f64, heading_inertia: f64) -> Result<Self, ModelError> {
        Ok(Self {
            mass: positive("mass", mass)?,
            radius: positive("radius", radius)?,
            spin_inertia: positive("moment of inertia about the axle", spin_inertia)?,
            heading_inertia: positive("moment of inertia about the diameter", heading_inertia)?,
        })
    }

    /// Mass `m` (kg).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Radius `R` (m).
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Moment of inertia `I` about the axle (kg m^2).
    #[must_use]
    pub fn spin_inertia(&self) -> f64 {
        self.spin_inertia
    }

    /// Moment of inertia `J` about the vertical diameter (kg m^2).
    #[must_use]
    pub fn heading_inertia(&self) -> f64 {
        self.heading_inertia
    }

    /// The spin momentum about the contact point, `(I + m R^2) phi'` (kg m^2/s).
    pub fn spin_momentum<S: Scalar>(&self, v: &[S; 4]) -> S {
        v[2] * (self.spin_inertia + self.mass * self.radius * self.radius)
    }

    /// The momentum about the vertical, `J theta'` (kg m^2/s).
    pub fn heading_momentum<S: Scalar>(&self, v: &[S; 4]) -> S {
        v[3] * self.heading_inertia
    }

    /// The centre of the circle that the contact point runs, times `theta'` (m/s):
    /// `(x, y) theta' + R phi' (-sin(theta), cos(theta))`.
    pub fn turning_centre<S: Scalar>(&self, q: &[S; 4], v: &[S; 4]) -> [S; 2] {
        let (sin, cos) = q[3].sin_cos();
        let speed = v[2] * self.radius;
        [q[0] * v[3] - speed * sin, q[1] * v[3] + speed * cos]
    }
}

macros::system! { lagrangian;
    impl RollingDisk;
    coordinates = { x = "m", y = "m", phi = "angle", theta = "angle" }
    parameters = { m = self.mass, R = self.radius, I = self.spin_inertia, J = self.heading_inertia }
    lagrangian = "m/2*(x'^2 + y'^2) + I/2*phi'^2 + J/2*theta'^2"
    constraints = ["x' - R*phi'*cos(theta)", "y' - R*phi'*sin(theta)"]
    // Roll, and turn.
    basis = [["R*cos(theta)", "R*sin(theta)", "1", "0"], ["0", "0", "0", "1"]]
}

impl Model<4, 2> for RollingDisk {
    fn name(&self) -> &'static str {
        "vertical rolling disk"
    }

    fn source(&self) -> &'static str {
        "Bloch 2015, Nonholonomic Mechanics and Control, section 1.4"
    }

    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: true, invariant_measure: true }
    }

    /// Spin at 1 rad/s, turn at 2 rad/s.
    fn start(&self) -> ModelState<4> {
        ([0.0; 4], [self.radius, 0.0, 1.0, 2.0])
    }

    /// Spin and turn rate are constant.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 4], v: &[f64; 4]) -> [f64; 4] {
        let (sin, cos) = q[3].sin_cos();
        let across = self.radius * v[2] * v[3];
        [-across * sin, across * cos, 0.0, 0.0]
    }

    fn invariants<S: Scalar>(&self, q: &[S; 4], v: &[S; 4]) -> Vec<(&'static str, S)> {
        let [x, y] = self.turning_centre(q, v);
        vec![
            ("energy", energy(self, S::zero(), q, v)),
            ("spin momentum", self.spin_momentum(v)),
            ("heading momentum", self.heading_momentum(v)),
            ("x of the turning centre, times the turn rate", x),
            ("y of the turning centre, times the turn rate", y),
        ]
    }

    fn density<S: Scalar>(&self, _q: &[S; 4]) -> Option<S> {
        Some(S::constant(1.0))
    }

    /// An arc of the radius `R phi' / theta'`: its chord lies along the mean heading.
    fn exact_from(&self, (q, v): &ModelState<4>, t: f64) -> Option<ModelState<4>> {
        let half = 0.5 * v[3] * t;
        let (sin, cos) = (q[3] + half).sin_cos();
        let chord = self.radius * v[2] * t * sinc(half);
        let end = [q[0] + chord * cos, q[1] + chord * sin, q[2] + v[2] * t, q[3] + v[3] * t];
        let (sin, cos) = end[3].sin_cos();
        let speed = self.radius * v[2];
        Some((end, [speed * cos, speed * sin, v[2], v[3]]))
    }
}
