use crate::error::positive;
use crate::{Labels, Model, ModelError, ModelState};

/// The roller racer: two bodies with an axle each, hinged to each other.
///
/// `q = (x, y, theta, phi)`: the mass centre of the rear body, on its axle (m), its heading, and the angle of the front
/// body to it (rad). The hinge is `d1` ahead of the rear axle, and the front axle `d2` ahead of the hinge, on the front
/// body; of that body's mass only its moment of inertia counts. No forces act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollerRacer {
    mass: f64,
    rear: f64,
    front: f64,
    d1: f64,
    d2: f64,
}

impl RollerRacer {
    /// A racer of mass `m` (kg) and the moments of inertia `I1` of its rear and `I2` of its front body (kg m^2), with
    /// the distances `d1` and `d2` of the axles from the hinge (m).
    ///
    /// # Errors
    /// [`ModelError`] names the parameter that is not positive.
    pub fn new(mass: f64, rear: f64, front: f64, d1: f64, d2: f64) -> Result<Self, ModelError> {
        Ok(Self {
            mass: positive("mass", mass)?,
            rear: positive("moment of inertia of the rear body", rear)?,
            front: positive("moment of inertia of the front body", front)?,
            d1: positive("distance of the rear axle", d1)?,
            d2: positive("distance of the front axle", d2)?,
        })
    }

    /// Mass `m` (kg).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// The moments of inertia `I1` and `I2` (kg m^2).
    #[must_use]
    pub fn inertias(&self) -> [f64; 2] {
        [self.rear, self.front]
    }

    /// The distances `d1` and `d2` of the axles from the hinge (m).
    #[must_use]
    pub fn distances(&self) -> [f64; 2] {
        [self.d1, self.d2]
    }
}

// Neither axle slips sideways.
macros::system! { lagrangian;
    impl RollerRacer;
    coordinates = { x = "m", y = "m", theta = "angle", phi = "angle" }
    parameters = { m = self.mass, I1 = self.rear, I2 = self.front, d1 = self.d1, d2 = self.d2 }
    lagrangian = "m/2*(x'^2 + y'^2) + I1/2*theta'^2 + I2/2*(theta' + phi')^2"
    constraints = [
        "y'*cos(theta) - x'*sin(theta)",
        "y'*cos(theta + phi) - x'*sin(theta + phi) + (d1*cos(phi) + d2)*theta' + d2*phi'",
    ]
    // Drive, and turn; the hinge follows, at `d2 phi' = u sin(phi) - (d1 cos(phi) + d2) theta'`.
    basis = [["cos(theta)", "sin(theta)", "0", "sin(phi)/d2"], ["0", "0", "1", "-d1/d2*cos(phi) - 1"]]
}

impl Model<4, 2> for RollerRacer {
    fn name(&self) -> &'static str {
        "roller racer"
    }

    fn source(&self) -> &'static str {
        "Krishnaprasad and Tsakiris 2001, Oscillations, SE(2)-snakes and motion control: a study of the roller racer, \
         Dynamical Systems 16, 347-397"
    }

    /// Its free motions are asymptotic, which a smooth measure forbids (Bizyaev 2017, The inertial motion of a roller
    /// racer, Regul. Chaotic Dyn. 22, 239-247).
    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: false, invariant_measure: false }
    }

    /// Forward at 1 m/s and turning at 0.3 rad/s, the hinge bent by half a radian.
    fn start(&self) -> ModelState<4> {
        let (bend, straight) = 0.5f64.sin_cos();
        let turn_rate = 0.3;
        let hinge = (bend - (self.d1 * straight + self.d2) * turn_rate) / self.d2;
        ([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, turn_rate, hinge])
    }

    /// With `u` the speed along the rear body and `w = theta' + phi' = (u sin(phi) - d1 theta' cos(phi)) / d2` the turn
    /// rate of the front one, the force of the front axle is `I2 w' / d2`:
    /// `m u' = -I2 w' sin(phi) / d2`, `I1 theta'' = I2 w' d1 cos(phi) / d2`, and
    /// `w' (1 + I2/d2^2 (sin^2/m + d1^2 cos^2/I1)) = phi' (u cos(phi) + d1 theta' sin(phi)) / d2`.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 4], v: &[f64; 4]) -> [f64; 4] {
        let ((sin, cos), (bend, straight)) = (q[2].sin_cos(), q[3].sin_cos());
        let Self { mass, rear, front, d1, d2 } = *self;
        let u = v[0] * cos + v[1] * sin;
        let lever = d1 * straight;
        let swing = v[3] * (u * straight + d1 * v[2] * bend) / d2;
        let w1 = swing / (1.0 + front / (d2 * d2) * (bend * bend / mass + lever * lever / rear));
        let force = front * w1 / d2;
        let (u1, theta2) = (-force * bend / mass, force * lever / rear);
        let across = u * v[2];
        [u1 * cos - across * sin, u1 * sin + across * cos, theta2, w1 - theta2]
    }
}
