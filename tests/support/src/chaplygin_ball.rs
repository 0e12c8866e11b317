use crate::ball::{attitude, attitude_part};
use crate::{Attitude, Model, ModelState};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, from_fn};

/// The Chaplygin ball: it rolls on a horizontal plane without slipping, its mass centre at its geometric centre and its
/// three principal moments of inertia any.
///
/// `q = (x, y, e_0, e_1, e_2, e_3)`: the centre over the plane (m), and the unit quaternion of [`Attitude`]. `|e| = 1` is a
/// constraint on positions, or with [`norm_by_rate`](Self::norm_by_rate) its rate alone. Below, `g = R' e_z` is the vertical as the
/// body sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChaplyginBall {
    mass: f64,
    radius: f64,
    inertia: [f64; 3],
    positions: bool,
}

impl ChaplyginBall {
    /// A ball of mass `m` (kg) and radius `r` (m), with the principal moments of inertia `I` about its centre (kg m^2).
    pub fn new(mass: f64, radius: f64, inertia: [f64; 3]) -> Self {
        Self { mass, radius, inertia, positions: true }
    }

    /// The same with the length of the quaternion held by its rate alone, for methods that refuse constraints on positions: which
    /// of them keep it is told at [`Attitude`].
    #[must_use]
    pub fn norm_by_rate(self) -> Self {
        Self { positions: false, ..self }
    }

    /// The state with the centre at a place (m), an attitude, and an angular velocity in space (rad/s), rolling.
    #[must_use]
    pub fn rolling(&self, place: [f64; 2], attitude: &Attitude<f64>, omega: [f64; 3]) -> ModelState<6> {
        let ([s, x, y, z], [s1, x1, y1, z1]) = (attitude.quaternion(), attitude.rates_of_space(&omega));
        let r = self.radius;
        ([place[0], place[1], s, x, y, z], [r * omega[1], -r * omega[0], s1, x1, y1, z1])
    }
}

impl System<6, 3> for ChaplyginBall {
    /// `L = m/2 (x'^2 + y'^2) + Omega . I Omega / 2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 6], v: &[S; 6]) -> S {
        let rates = attitude_part(v);
        let omega = attitude(q).body_velocity(&rates);
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass) + Attitude::turning_energy(&rates, &omega, self.inertia)
    }

    /// `x' = r omega_y`, `y' = -r omega_x`, with `omega` the angular velocity in space; and `e . e' = 0`.
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
            [zero; 3],
        )
    }

    /// `(|e|^2 - 1)/2 = 0`.
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Option<[Option<S>; 3]> {
        self.positions.then(|| [None, None, Some(attitude(q).norm_miss())])
    }

    /// The turns at 1 rad/s about the axes of the body, rolling: quasi-velocities are `Omega`.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Option<AdmissibleBasis<S, 6, 3>> {
        let attitude = attitude(q);
        let [along_x, along_y, _] = attitude.rotation();
        let turns = attitude.body_turns();
        Some(AdmissibleBasis::new(from_fn::<_, 3, _>(|k| {
            let e = turns[k];
            [along_y[k] * self.radius, -along_x[k] * self.radius, e[0], e[1], e[2], e[3]]
        })))
    }
}

impl Model<6, 3> for ChaplyginBall {
    fn name(&self) -> &'static str {
        if self.positions { "Chaplygin ball" } else { "Chaplygin ball, norm by its rate" }
    }

    fn start(&self) -> ModelState<6> {
        self.admissible([0.0, 0.0, 0.98, 0.1, -0.15, 0.06], [0.5, 0.8, -0.4, 0.0, 0.0, 0.0])
    }

    /// At the attitude nearest to the given numbers, turning at `xi` about the axes of the body.
    fn admissible(&self, q: [f64; 6], xi: [f64; 6]) -> ModelState<6> {
        let attitude = Attitude::nearest(attitude_part(&q));
        self.rolling([q[0], q[1]], &attitude, attitude.in_space(&[xi[0], xi[1], xi[2]]))
    }
}
