use crate::checks::not_negative;
use crate::{SleighBody, SleighError};
use lagrangian::{Effect, Scalar};

/// The drag of a fast body in air or water: the force `-c_u u |u|` along the blade at its contact point, and the torque
/// `-c_omega omega |omega|`.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadraticDrag {
    along: f64,
    turning: f64,
}

impl QuadraticDrag {
    /// The drag with the coefficients `c_u` (kg/m) and `c_omega` (kg m^2), neither negative.
    ///
    /// # Errors
    /// [`SleighError::Negative`] names the coefficient.
    pub fn new(along: f64, turning: f64) -> Result<Self, SleighError> {
        Ok(Self { along: not_negative("along", along)?, turning: not_negative("turning", turning)? })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for QuadraticDrag {
    #[inline(always)]
    fn force<S: Scalar>(&self, _body: &B, _t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let (sin, cos) = q[2].sin_cos();
        let speed = cos * v[0] + sin * v[1];
        let push = speed * speed.abs() * -self.along;
        let turn = v[2] * v[2].abs() * -self.turning;
        let mut force = [S::zero(); N];
        force[..3].copy_from_slice(&[push * cos, push * sin, turn]);
        Some(force)
    }
}
