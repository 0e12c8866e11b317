use crate::checks::not_negative;
use crate::series::{OwnPush, PushInOwnAxes};
use crate::{SleighBody, SleighError};
use lagrangian::{Effect, Scalar};

/// Viscous drag: the force `-c_u u` along the blade at its contact point, and the torque `-c_omega omega`.
#[derive(Debug, Clone, PartialEq)]
pub struct Drag {
    along: f64,
    turning: f64,
}

impl Drag {
    /// The drag with the coefficients `c_u` (kg/s) and `c_omega` (kg m^2/s), neither negative.
    ///
    /// # Errors
    /// [`SleighError::Negative`] names the coefficient.
    pub fn new(along: f64, turning: f64) -> Result<Self, SleighError> {
        Ok(Self { along: not_negative("along", along)?, turning: not_negative("turning", turning)? })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Drag {
    #[inline(always)]
    fn force<S: Scalar>(&self, _body: &B, _t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let (sin, cos) = q[2].sin_cos();
        let push = (cos * v[0] + sin * v[1]) * -self.along;
        let turn = v[2] * -self.turning;
        let mut force = [S::zero(); N];
        force[..3].copy_from_slice(&[push * cos, push * sin, turn]);
        Some(force)
    }
}

impl<B> PushInOwnAxes<B> for Drag {
    fn in_own_axes(&self, _body: &B) -> Option<OwnPush> {
        Some(OwnPush { drag: [self.along, self.turning], ..OwnPush::NOTHING })
    }
}
