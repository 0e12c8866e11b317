use lagrangian::{Scalar, from_fn, mapped};

/// The attitude of a rigid body by a unit quaternion `e = (e_0, e_1, e_2, e_3)`, `|e| = 1`: four coordinates without a singular
/// attitude, for a system that has them among its own.
///
/// It is the turn by `2 acos(e_0)` about the axis `(e_1, e_2, e_3)`; `e` and `-e` are the same attitude. The matrix `R` takes
/// body components to those in space. With `Omega` the angular velocity in the body, `omega = R Omega` that in space, and
/// products of quaternions,
///
/// ```text
/// e' = e Omega / 2 = omega e / 2,      |e|^2 = 1,      e . e' = 0.
/// ```
///
/// A system gives the last as a row of its constraint ([`norm_row`](Self::norm_row)) and the one before it as the row's function
/// of positions ([`norm_miss`](Self::norm_miss)): every method that carries constraints on positions then holds `|e|` to
/// round-off, however long the run. Methods that refuse those (the energy-preserving ones) are given the row alone. Then `|e|` is held
/// but for roundings of increments, a random walk that no run of 1e5 steps shows, by what keeps functions of second degree: the
/// midpoint and trapezoidal `dla` and their compositions, Gauss collocation, and the energy-preserving collocation. Lobatto's
/// methods, `gni` and Runge-Kutta methods let it drift by their order.
///
/// (Betsch and Siebert 2009, Rigid body dynamics in terms of quaternions: Hamiltonian formulation and conserving numerical
/// integration, Int. J. Numer. Methods Engrg. 79, 444-473.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude<S> {
    e: [S; 4],
}

impl<S: Scalar> Attitude<S> {
    /// The attitude of a quaternion, which is taken to be of length one.
    #[must_use]
    #[inline(always)]
    pub fn new(e: [S; 4]) -> Self {
        Self { e }
    }

    /// The quaternion.
    #[must_use]
    #[inline(always)]
    pub fn quaternion(&self) -> [S; 4] {
        self.e
    }

    /// The row `e` of `e . e' = 0`: the rate of [`norm_miss`](Self::norm_miss).
    #[must_use]
    #[inline(always)]
    pub fn norm_row(&self) -> [S; 4] {
        self.e
    }

    /// `(|e|^2 - 1)/2`, which vanishes.
    #[must_use]
    #[inline(always)]
    pub fn norm_miss(&self) -> S {
        (sum_of_squares(&self.e) - 1.0) * 0.5
    }

    /// The matrix `R`, by rows.
    #[must_use]
    #[inline(always)]
    pub fn rotation(&self) -> [[S; 3]; 3] {
        let [s, x, y, z] = self.e;
        let (ss, xx, yy, zz) = (s * s, x * x, y * y, z * z);
        let (xy, xz, yz) = (x * y, x * z, y * z);
        let (sx, sy, sz) = (s * x, s * y, s * z);
        [
            [ss + xx - yy - zz, (xy - sz) * 2.0, (xz + sy) * 2.0],
            [(xy + sz) * 2.0, ss - xx + yy - zz, (yz - sx) * 2.0],
            [(xz - sy) * 2.0, (yz + sx) * 2.0, ss - xx - yy + zz],
        ]
    }

    /// The components in space, `R x`, of a vector that has the components `x` in the body.
    #[must_use]
    #[inline(always)]
    pub fn in_space(&self, x: &[S; 3]) -> [S; 3] {
        mapped(&self.rotation(), |row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
    }

    /// The rates `e'` of turns at 1 rad/s about the axes of the body. They are orthogonal to `e` and to one another, of length
    /// one half: a basis of the admissible rates.
    #[must_use]
    #[inline(always)]
    pub fn body_turns(&self) -> [[S; 4]; 3] {
        mapped(&body(&self.e), |row| mapped(&row, |part| part * 0.5))
    }

    /// The rates `e'` of turns at 1 rad/s about the axes of space, as [`body_turns`](Self::body_turns).
    #[must_use]
    #[inline(always)]
    pub fn space_turns(&self) -> [[S; 4]; 3] {
        mapped(&space(&self.e), |row| mapped(&row, |part| part * 0.5))
    }

    /// The matrix, by rows, that takes rates `e'` to the angular velocity in space (rad/s).
    #[must_use]
    #[inline(always)]
    pub fn space_velocity_matrix(&self) -> [[S; 4]; 3] {
        mapped(&space(&self.e), |row| mapped(&row, |part| part * 2.0))
    }

    /// The angular velocity `Omega` in the body (rad/s), of the rates `e'`.
    #[must_use]
    #[inline(always)]
    pub fn body_velocity(&self, rates: &[S; 4]) -> [S; 3] {
        mapped(&body(&self.e), |row| dot(&row, rates) * 2.0)
    }

    /// The angular velocity `omega` in space (rad/s), of the rates `e'`.
    #[must_use]
    #[inline(always)]
    pub fn space_velocity(&self, rates: &[S; 4]) -> [S; 3] {
        mapped(&space(&self.e), |row| dot(&row, rates) * 2.0)
    }

    /// The rates `e'` of an angular velocity `Omega` in the body (rad/s).
    #[must_use]
    #[inline(always)]
    pub fn rates_of_body(&self, omega: &[S; 3]) -> [S; 4] {
        combined(&self.body_turns(), omega)
    }

    /// The rates `e'` of an angular velocity `omega` in space (rad/s).
    #[must_use]
    #[inline(always)]
    pub fn rates_of_space(&self, omega: &[S; 3]) -> [S; 4] {
        combined(&self.space_turns(), omega)
    }

    /// The kinetic energy of the turn (J), of the rates `e'`, the angular velocity `Omega` in the body (rad/s) and the principal
    /// moments of inertia (kg m^2): `2 I |e'|^2 + sum (I_i - I) Omega_i^2 / 2` with their mean `I`.
    ///
    /// On the constraint that is `sum I_i Omega_i^2 / 2`, and off it a positive form of all four rates, as a mass matrix that is
    /// to be inverted must be. For a body of equal moments it does not depend on the attitude: a variational step then keeps
    /// an even turn exactly.
    #[must_use]
    #[inline(always)]
    pub fn turning_energy(rates: &[S; 4], omega: &[S; 3], moments: [f64; 3]) -> S {
        let mean = (moments[0] + moments[1] + moments[2]) / 3.0;
        sum_of_squares(rates) * (2.0 * mean)
            + omega[0] * omega[0] * (0.5 * (moments[0] - mean))
            + omega[1] * omega[1] * (0.5 * (moments[1] - mean))
            + omega[2] * omega[2] * (0.5 * (moments[2] - mean))
    }
}

impl Attitude<f64> {
    /// Body axes along the axes of space.
    pub const LEVEL: Self = Self { e: [1.0, 0.0, 0.0, 0.0] };

    /// Turned from there by an angle (rad) about an axis of any length; not at all about none.
    #[must_use]
    pub fn about(axis: [f64; 3], angle: f64) -> Self {
        let [_, x, y, z] = Self::nearest([0.0, axis[0], axis[1], axis[2]]).e;
        let (sin, cos) = (0.5 * angle).sin_cos();
        match x == 0.0 && y == 0.0 && z == 0.0 {
            true => Self::LEVEL,
            false => Self { e: [cos, sin * x, sin * y, sin * z] },
        }
    }

    /// The attitude whose quaternion is nearest to four numbers; [`LEVEL`](Self::LEVEL) where they have no direction.
    #[must_use]
    pub fn nearest(numbers: [f64; 4]) -> Self {
        // Divided by the largest first, so that no square leaves the range of numbers.
        let largest = numbers.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let scaled = mapped(&numbers, |x| x / largest);
        let length = sum_of_squares(&scaled).sqrt();
        match length.is_finite() && length > 0.0 {
            true => Self { e: mapped(&scaled, |x| x / length) },
            false => Self::LEVEL,
        }
    }

    /// Turned by `self` after `first`, both about axes of space; or first by `self`, then by `first` about the axes of the body:
    /// the matrix `R(self) R(first)`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let ([s, x, y, z], [a, b, c, d]) = (self.e, first.e);
        Self::nearest([
            s * a - x * b - y * c - z * d,
            s * b + x * a + y * d - z * c,
            s * c - x * d + y * a + z * b,
            s * d + x * c - y * b + z * a,
        ])
    }
}

/// Half of `Omega` by rates: the rows of the products `e i`, `e j`, `e k`.
#[inline(always)]
fn body<S: Scalar>(e: &[S; 4]) -> [[S; 4]; 3] {
    let [s, x, y, z] = *e;
    [[-x, s, z, -y], [-y, -z, s, x], [-z, y, -x, s]]
}

/// Half of `omega` by rates: the rows of the products `i e`, `j e`, `k e`.
#[inline(always)]
fn space<S: Scalar>(e: &[S; 4]) -> [[S; 4]; 3] {
    let [s, x, y, z] = *e;
    [[-x, s, -z, y], [-y, z, s, -x], [-z, -y, x, s]]
}

#[inline(always)]
fn dot<S: Scalar>(a: &[S; 4], b: &[S; 4]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

#[inline(always)]
fn sum_of_squares<S: Scalar>(e: &[S; 4]) -> S {
    dot(e, e)
}

#[inline(always)]
fn combined<S: Scalar>(rows: &[[S; 4]; 3], omega: &[S; 3]) -> [S; 4] {
    from_fn(|i| rows[0][i] * omega[0] + rows[1][i] * omega[1] + rows[2][i] * omega[2])
}
