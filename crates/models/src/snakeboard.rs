use crate::error::positive;
use crate::{Labels, Model, ModelError, ModelState};
use lagrangian::{Scalar, energy};

/// The snakeboard: a board on two wheel axles that steer by opposite angles, with a rotor at its centre.
///
/// `q = (x, y, theta, psi, phi)`: the board's centre (m), its heading, the rotor's angle on the board, and the steering
/// angle, `phi` of the back axle and `-phi` of the front one (rad). No forces act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snakeboard {
    mass: f64,
    length: f64,
    board: f64,
    rotor: f64,
    wheels: f64,
}

impl Snakeboard {
    /// A snakeboard of the whole mass `m` (kg) and the distance `l` (m) of each axle from the centre, with the moments
    /// of inertia `J` of the board, `J_r` of the rotor and `J_w` of each axle, each about its own centre (kg m^2).
    ///
    /// The literature often takes `J + J_r + 2 J_w = m l^2`.
    ///
    /// # Errors
    /// [`ModelError`] names the parameter that is not positive.
    pub fn new(mass: f64, length: f64, board: f64, rotor: f64, wheels: f64) -> Result<Self, ModelError> {
        Ok(Self {
            mass: positive("mass", mass)?,
            length: positive("distance of the axles", length)?,
            board: positive("moment of inertia of the board", board)?,
            rotor: positive("moment of inertia of the rotor", rotor)?,
            wheels: positive("moment of inertia of the wheels", wheels)?,
        })
    }

    /// Mass `m` (kg).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Distance `l` of each axle from the centre (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The moments of inertia `J`, `J_r`, `J_w` (kg m^2).
    #[must_use]
    pub fn inertias(&self) -> [f64; 3] {
        [self.board, self.rotor, self.wheels]
    }

    /// The rotor's absolute angular momentum, `J_r (theta' + psi')` (kg m^2/s).
    pub fn rotor_momentum<S: Scalar>(&self, v: &[S; 5]) -> S {
        (v[2] + v[3]) * self.rotor
    }

    /// The momentum of the steering, `2 J_w phi'` (kg m^2/s).
    pub fn steering_momentum<S: Scalar>(&self, v: &[S; 5]) -> S {
        v[4] * (2.0 * self.wheels)
    }

    /// `m l^2 cos(phi)^2 + (J + 2 J_w) sin(phi)^2` (kg m^2), the inertia of the drive.
    fn drive_inertia<S: Scalar>(&self, phi: S) -> S {
        let (sin, cos) = phi.sin_cos();
        cos * cos * (self.mass * self.length * self.length) + sin * sin * (self.board + 2.0 * self.wheels)
    }
}

// The constraints are the sum and the difference of those of the two axles: with `u` the speed along the board and `s` that across it, `s = 0`
// and `u sin(phi) + l theta' cos(phi) = 0`. Back and front, `-sin(phi) u + cos(phi) (s - l theta') = 0` and
// `sin(phi) u + cos(phi) (s + l theta') = 0`, are the same constraint where `cos(phi) = 0`; their sum and difference stay two.
macros::system! { lagrangian;
    impl Snakeboard;
    coordinates = { x = "m", y = "m", theta = "angle", psi = "angle", phi = "angle" }
    parameters = { m = self.mass, l = self.length, J = self.board, Jr = self.rotor, Jw = self.wheels }
    lagrangian = "m/2*(x'^2 + y'^2) + J/2*theta'^2 + Jr/2*(theta' + psi')^2 + Jw/2*((theta' + phi')^2 + (theta' - phi')^2)"
    constraints = ["y'*cos(theta) - x'*sin(theta)", "sin(phi)*(x'*cos(theta) + y'*sin(theta)) + l*cos(phi)*theta'"]
    // Drive along the arc of the wheels, turn the rotor, and steer.
    basis = [
        ["l*cos(phi)*cos(theta)", "l*cos(phi)*sin(theta)", "-sin(phi)", "0", "0"],
        ["0", "0", "0", "1", "0"],
        ["0", "0", "0", "0", "1"],
    ]
}

impl Model<5, 2> for Snakeboard {
    fn name(&self) -> &'static str {
        "snakeboard"
    }

    fn source(&self) -> &'static str {
        "Lewis, Ostrowski, Murray and Burdick 1994, Nonholonomic mechanics and locomotion: the snakeboard example, \
         Proc. IEEE Int. Conf. Robotics and Automation, 2391-2397"
    }

    /// `phi'` is constant, and the energy of the drive is an integral by itself.
    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: true, invariant_measure: true }
    }

    /// On an arc, steering and with the rotor turning.
    fn start(&self) -> ModelState<5> {
        let (sin, cos) = 0.3f64.sin_cos();
        ([0.0, 0.0, 0.0, 0.0, 0.3], [self.length * cos, 0.0, -sin, 0.5, 0.2])
    }

    /// With `u = l s cos(phi)`, `theta' = -s sin(phi)`, `k = J + 2 J_w`: `phi'' = 0`, `psi'' = -theta''` and
    /// `(m l^2 cos^2 + k sin^2) s' = (m l^2 - k) sin cos phi' s`.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 5], v: &[f64; 5]) -> [f64; 5] {
        let ((sin, cos), (steer, straight)) = (q[2].sin_cos(), q[4].sin_cos());
        let l = self.length;
        let (rolling, turning) = (self.mass * l * l, self.board + 2.0 * self.wheels);
        let u = v[0] * cos + v[1] * sin;
        let s = u / l * straight - v[2] * steer;
        let s1 = (rolling - turning) * steer * straight * v[4] * s / self.drive_inertia(q[4]);
        let u1 = l * (s1 * straight - s * steer * v[4]);
        let theta2 = -s1 * steer - s * straight * v[4];
        let across = u * v[2];
        [u1 * cos - across * sin, u1 * sin + across * cos, theta2, -theta2, 0.0]
    }

    fn invariants<S: Scalar>(&self, q: &[S; 5], v: &[S; 5]) -> Vec<(&'static str, S)> {
        vec![
            ("energy", energy(self, S::zero(), q, v)),
            ("rotor momentum", self.rotor_momentum(v)),
            ("steering momentum", self.steering_momentum(v)),
        ]
    }

    fn density<S: Scalar>(&self, q: &[S; 5]) -> Option<S> {
        Some(self.drive_inertia(q[4]).sqrt())
    }
}
