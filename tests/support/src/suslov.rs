use crate::{Attitude, Model, ModelState};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// The Suslov problem: a rigid body about a fixed point that cannot turn about its own third axis, `Omega3 = 0`.
///
/// `q = (e_0, e_1, e_2, e_3)`: the unit quaternion of [`Attitude`]. `Omega` is the angular velocity in the body, in axes turned
/// about the third so that `I12 = 0`. `|e| = 1` is a constraint on positions, or with [`norm_by_rate`](Self::norm_by_rate) its rate
/// alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suslov {
    diagonal: [f64; 3],
    i13: f64,
    i23: f64,
    positions: bool,
}

impl Suslov {
    /// A body of the inertia matrix `((I11, 0, I13), (0, I22, I23), (I13, I23, I33))` (kg m^2); `I13` and `I23` are the
    /// entries, the products of inertia with their minus sign.
    pub fn new(diagonal: [f64; 3], i13: f64, i23: f64) -> Self {
        Self { diagonal, i13, i23, positions: true }
    }

    /// The same with the length of the quaternion held by its rate alone, for methods that refuse constraints on positions: which
    /// of them keep it is told at [`Attitude`].
    #[must_use]
    pub fn norm_by_rate(self) -> Self {
        Self { positions: false, ..self }
    }

    /// The solution of the reduced equations, a time `t` (s) after `omega` (rad/s).
    ///
    /// In `(X, Y) = (sqrt(I11) Omega1, sqrt(I22) Omega2)` they run a circle of radius `R`; with `P` along
    /// `(I13/sqrt(I11), I23/sqrt(I22))` of length `n`, and `Q` a quarter turn further, `Q = R tanh(nu R (t - t0))`,
    /// `P = +-R sech(nu R (t - t0))`, `nu = n/sqrt(I11 I22)`.
    #[must_use]
    pub fn exact_reduced(&self, omega: [f64; 2], t: f64) -> [f64; 2] {
        let [i11, i22, _] = self.diagonal;
        let (root1, root2) = (i11.sqrt(), i22.sqrt());
        let (a, b) = (self.i13 / root1, self.i23 / root2);
        let n = a.hypot(b);
        let (x, y) = (root1 * omega[0], root2 * omega[1]);
        let radius = x.hypot(y);
        if n == 0.0 || radius == 0.0 {
            return omega;
        }
        let (p, q) = ((a * x + b * y) / n, (a * y - b * x) / n);
        let s = n / (root1 * root2) * radius * t;
        // 1 + Q/R and 1 - Q/R, the smaller one from P^2 + Q^2 = R^2.
        let (k, flat) = (q / radius, p / radius);
        let large = 1.0 + k.abs();
        let small = flat * flat / large;
        let (up, down) = if k >= 0.0 { (large, small) } else { (small, large) };
        // Both sides of the quotient (up e^s -+ down e^-s), without their large factor.
        let decay = (-2.0 * s.abs()).exp();
        let (up, down) = if s >= 0.0 { (up, down * decay) } else { (up * decay, down) };
        let (p, q) = (2.0 * p * (-s.abs()).exp() / (up + down), radius * (up - down) / (up + down));
        [(a * p - b * q) / (n * root1), (b * p + a * q) / (n * root2)]
    }
}

impl System<4, 2> for Suslov {
    /// `L = Omega . I Omega / 2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 4], v: &[S; 4]) -> S {
        let omega = Attitude::new(*q).body_velocity(v);
        Attitude::turning_energy(v, &omega, self.diagonal) + (omega[0] * self.i13 + omega[1] * self.i23) * omega[2]
    }

    /// `Omega3 / 2 = 0`, and `e . e' = 0`: at right angles, and of one length.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Constraint<S, 4, 2> {
        let [s, x, y, z] = *q;
        ([[-z, y, -x, s], Attitude::new(*q).norm_row()], [S::zero(); 2])
    }

    /// `(|e|^2 - 1)/2 = 0`.
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Option<[Option<S>; 2]> {
        self.positions.then(|| [None, Some(Attitude::new(*q).norm_miss())])
    }

    /// The turns at 1 rad/s about the first and the second axis of the body: quasi-velocities are `Omega1` and `Omega2`.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Option<AdmissibleBasis<S, 4, 2>> {
        let [first, second, _] = Attitude::new(*q).body_turns();
        Some(AdmissibleBasis::new([first, second]))
    }
}

impl Model<4, 2> for Suslov {
    fn name(&self) -> &'static str {
        if self.positions { "Suslov problem" } else { "Suslov problem, norm by its rate" }
    }

    fn start(&self) -> ModelState<4> {
        self.admissible([0.98, 0.1, -0.15, 0.06], [0.6, 0.2, 0.0, 0.0])
    }

    /// At the attitude nearest to the given numbers, turning at `xi`.
    fn admissible(&self, q: [f64; 4], xi: [f64; 4]) -> ModelState<4> {
        let attitude = Attitude::nearest(q);
        (attitude.quaternion(), attitude.rates_of_body(&[xi[0], xi[1], 0.0]))
    }
}
