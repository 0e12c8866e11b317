use lagrangian::Scalar;

/// The attitude `R = Rx(alpha) Ry(beta) Rz(gamma)` of a rigid body, by Tait-Bryan angles.
///
/// `R` takes body components to those in space. The chart is regular around `R = 1`, and singular where
/// `cos(beta) = 0`, the quarter turns of the middle angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude<S> {
    alpha: (S, S),
    beta: (S, S),
    gamma: (S, S),
}

impl<S: Scalar> Attitude<S> {
    /// The attitude of the angles `(alpha, beta, gamma)` (rad).
    #[inline(always)]
    pub fn new([alpha, beta, gamma]: [S; 3]) -> Self {
        Self { alpha: alpha.sin_cos(), beta: beta.sin_cos(), gamma: gamma.sin_cos() }
    }

    /// The matrix `R`, by rows.
    #[inline(always)]
    pub fn rotation(&self) -> [[S; 3]; 3] {
        let ((sa, ca), (sb, cb), (sc, cc)) = (self.alpha, self.beta, self.gamma);
        [
            [cb * cc, -cb * sc, sb],
            [ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb],
            [sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb],
        ]
    }

    /// The angular velocity in the body (rad/s), of the angles' rates.
    #[inline(always)]
    pub fn body_velocity(&self, rates: [S; 3]) -> [S; 3] {
        let ((sb, cb), (sc, cc)) = (self.beta, self.gamma);
        let across = cb * rates[0];
        [across * cc + rates[1] * sc, rates[1] * cc - across * sc, sb * rates[0] + rates[2]]
    }

    /// The matrix, by rows, that takes the rates of the angles to the angular velocity in space.
    #[inline(always)]
    pub fn space_velocity_matrix(&self) -> [[S; 3]; 3] {
        let ((sa, ca), (sb, cb)) = (self.alpha, self.beta);
        let (zero, one) = (S::zero(), S::constant(1.0));
        [[one, zero, sb], [zero, ca, -sa * cb], [zero, sa, ca * cb]]
    }

    /// `cos(beta)`, which vanishes where the angles are singular.
    #[inline(always)]
    pub fn regularity(&self) -> S {
        self.beta.1
    }
}

impl Attitude<f64> {
    /// The rates of the angles (rad/s), of an angular velocity in the body.
    #[must_use]
    pub fn rates(&self, omega: [f64; 3]) -> [f64; 3] {
        let ((sb, cb), (sc, cc)) = (self.beta, self.gamma);
        let alpha = (omega[0] * cc - omega[1] * sc) / cb;
        [alpha, omega[0] * sc + omega[1] * cc, omega[2] - alpha * sb]
    }

    /// The second derivatives of the angles (rad/s^2), of their rates and the angular acceleration in the body.
    #[must_use]
    pub fn accelerations(&self, rates: [f64; 3], omega: [f64; 3]) -> [f64; 3] {
        let ((sb, cb), (sc, cc)) = (self.beta, self.gamma);
        let [a, b, c] = rates;
        let alpha = (omega[0] * cc - omega[1] * sc - c * b + a * b * sb) / cb;
        let beta = omega[0] * sc + omega[1] * cc + c * a * cb;
        [alpha, beta, omega[2] - alpha * sb - a * b * cb]
    }
}
