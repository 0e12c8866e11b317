use crate::ball::{attitude, attitude_part};
use crate::{Attitude, Model, ModelState};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, energy, velocity_of};

/// A homogeneous ball that rolls on a level table, which turns about the origin at a given rate: constraints that are affine
/// in the velocities, and one on positions.
///
/// `q = (x, y, e_0, e_1, e_2, e_3)`: the centre (m) and the unit quaternion of [`Attitude`].
/// The centre runs a circle at `Omega k/(1 + k)`, with `k = I/(m r^2)`: 2/7 of the table's rate for a solid ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurntableBall {
    mass: f64,
    radius: f64,
    inertia: f64,
    rate: f64,
}

impl TurntableBall {
    /// A ball of mass `m` (kg), radius `r` (m) and moment of inertia `I` about every diameter (kg m^2), on a table that turns
    /// at `Omega` (rad/s), of either sign.
    pub fn new(mass: f64, radius: f64, inertia: f64, rate: f64) -> Self {
        Self { mass, radius, inertia, rate }
    }

    /// The rate of the centre on its circle (rad/s).
    #[must_use]
    pub fn circling(&self) -> f64 {
        self.rate * self.inertia / (self.inertia + self.mass * self.radius * self.radius)
    }

    /// The angular velocity in space (rad/s).
    pub fn spin<S: Scalar>(&self, q: &[S; 6], v: &[S; 6]) -> [S; 3] {
        attitude(q).space_velocity(&attitude_part(v))
    }

    /// `E - Omega (m (x y' - y x') + I omega_z)` (J), which is kept where the energy is not.
    pub fn moving_energy<S: Scalar>(&self, q: &[S; 6], v: &[S; 6]) -> S {
        let [_, _, spin] = self.spin(q, v);
        let about_axis = (q[0] * v[1] - q[1] * v[0]) * self.mass + spin * self.inertia;
        energy(self, S::zero(), q, v) - about_axis * self.rate
    }

    /// Place and velocity of the centre a time `t` (s) after the given state, on its circle.
    #[must_use]
    pub fn centre_from(&self, (q, v): &ModelState<6>, t: f64) -> ([f64; 2], [f64; 2]) {
        let w = self.circling();
        let (sin, cos) = (w * t).sin_cos();
        // int_0^t of the cosine and of the sine, down to w = 0.
        let half = 0.5 * w * t;
        let mean = if half == 0.0 { 1.0 } else { half.sin() / half };
        let (c, s) = (t * mean * half.cos(), t * mean * half.sin());
        ([q[0] + c * v[0] - s * v[1], q[1] + c * v[1] + s * v[0]], [cos * v[0] - sin * v[1], cos * v[1] + sin * v[0]])
    }
}

impl System<6, 3> for TurntableBall {
    /// `L = m/2 (x'^2 + y'^2) + 2 I |e'|^2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 6], v: &[S; 6]) -> S {
        let turn = v[2] * v[2] + v[3] * v[3] + v[4] * v[4] + v[5] * v[5];
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass) + turn * (2.0 * self.inertia)
    }

    /// Contact at the table's speed, `x' - r omega_y + Omega y = 0`, `y' + r omega_x - Omega x = 0`; and `e . e' = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Constraint<S, 6, 3> {
        let attitude = attitude(q);
        let [x, y, _] = attitude.space_velocity_matrix().map(|row| row.map(|part| part * self.radius));
        let e = attitude.norm_row();
        let (zero, one) = (S::zero(), S::constant(1.0));
        (
            [
                [one, zero, -y[0], -y[1], -y[2], -y[3]],
                [zero, one, x[0], x[1], x[2], x[3]],
                [zero, zero, e[0], e[1], e[2], e[3]],
            ],
            [q[1] * self.rate, -q[0] * self.rate, zero],
        )
    }

    /// `(|e|^2 - 1)/2 = 0`.
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Option<[Option<S>; 3]> {
        Some([None, None, Some(attitude(q).norm_miss())])
    }

    /// The three turns at 1 rad/s about the axes of space, rolling.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Option<AdmissibleBasis<S, 6, 3>> {
        let e = [q[2], q[3], q[4], q[5]];
        let reach = (e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]) * self.radius;
        let [x, y, z] = Attitude::new(e).space_turns();
        let zero = S::zero();
        Some(AdmissibleBasis::new([
            [zero, -reach, x[0], x[1], x[2], x[3]],
            [reach, zero, y[0], y[1], y[2], y[3]],
            [zero, zero, z[0], z[1], z[2], z[3]],
        ]))
    }
}

impl Model<6, 3> for TurntableBall {
    fn name(&self) -> &'static str {
        "ball on a turntable"
    }

    /// A table that turns is not reversed with the velocities.
    fn reversible(&self) -> bool {
        self.rate == 0.0
    }

    fn start(&self) -> ModelState<6> {
        self.admissible([0.4, -0.2, 0.9, 0.1, -0.3, 0.3], [0.7, -0.4, 0.5, 0.0, 0.0, 0.0])
    }

    /// At the attitude nearest to the given numbers, turning at `xi` beside what the table adds.
    fn admissible(&self, q: [f64; 6], xi: [f64; 6]) -> ModelState<6> {
        let [s, x, y, z] = Attitude::nearest(attitude_part(&q)).quaternion();
        let q = [q[0], q[1], s, x, y, z];
        // Three independent rows at every attitude, so there is always one.
        let v = velocity_of(self, 0.0, &q, &xi).unwrap_or([0.0; 6]);
        (q, v)
    }
}
