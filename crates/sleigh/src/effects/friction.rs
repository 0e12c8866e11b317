use crate::checks::{not_negative, positive};
use crate::{SleighBody, SleighError};
use lagrangian::{Effect, Scalar};

/// Coulomb friction, smoothed at rest: the force `-F tanh(u/u_0)` along the blade at its contact point, and the torque
/// `-T tanh(omega/omega_0)`.
///
/// Rolling resistance is of this form with `F = c m g`. The law without smoothing jumps at rest, where no method has an order; beyond
/// a few `u_0` the two agree to round-off. Below `u_0` the friction is the viscous one `-F/u_0 u`, so that the sleigh comes to rest
/// in the limit only, and creeps where a force below `F` pushes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// `F` (N) and `u_0` (m/s).
    along: [f64; 2],
    /// `T` (N m) and `omega_0` (rad/s).
    turning: [f64; 2],
}

impl Friction {
    /// The friction `F` (N) along the blade, smoothed over the speed `u_0` (m/s), and the torque `T` (N m), smoothed over the turn rate
    /// `omega_0` (rad/s).
    ///
    /// # Errors
    /// [`SleighError::Negative`] names the force or the torque, [`SleighError::NotPositive`] what smooths it.
    pub fn new(along: f64, smoothing: f64, turning: f64, turning_smoothing: f64) -> Result<Self, SleighError> {
        Ok(Self {
            along: [not_negative("along", along)?, positive("smoothing", smoothing)?],
            turning: [not_negative("turning", turning)?, positive("turning_smoothing", turning_smoothing)?],
        })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Friction {
    #[inline(always)]
    fn force<S: Scalar>(&self, _body: &B, _t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let (sin, cos) = q[2].sin_cos();
        let against = |rate: S, [force, smoothing]: [f64; 2]| (rate / smoothing).tanh() * -force;
        let push = against(cos * v[0] + sin * v[1], self.along);
        let mut force = [S::zero(); N];
        force[..3].copy_from_slice(&[push * cos, push * sin, against(v[2], self.turning)]);
        Some(force)
    }
}
