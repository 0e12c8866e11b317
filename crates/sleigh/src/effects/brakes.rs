//! Forces against the motion.

use crate::error::{not_negative, positive};
use crate::series::{OwnPush, PushInOwnAxes};
use crate::{Sleigh, SleighBody, SleighError};
use lagrangian::{Effect, Scalar};
use serde::Serialize;

/// Viscous drag: the force `-c_u u` along the blade at its contact point, and the torque `-c_omega omega`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Drag {
    /// `c_u` (kg/s).
    pub along: f64,
    /// `c_omega` (kg m^2/s).
    pub turning: f64,
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

impl PushInOwnAxes for Drag {
    fn in_own_axes(&self, _sleigh: &Sleigh) -> Option<OwnPush> {
        Some(OwnPush { drag: [self.along, self.turning], ..OwnPush::NOTHING })
    }
}

/// The drag of a fast body in air or water: the force `-c_u u |u|` along the blade at its contact point, and the torque
/// `-c_omega omega |omega|`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuadraticDrag {
    /// `c_u` (kg/m).
    pub along: f64,
    /// `c_omega` (kg m^2).
    pub turning: f64,
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

impl PushInOwnAxes for QuadraticDrag {}

/// Coulomb friction, smoothed at rest: the force `-F tanh(u/u_0)` along the blade at its contact point, and the torque
/// `-T tanh(omega/omega_0)`.
///
/// Rolling resistance is of this form with `F = c m g`. The law without smoothing jumps at rest, where no method has an order; beyond
/// a few `u_0` the two agree to round-off. Below `u_0` the friction is the viscous one `-F/u_0 u`, so that the sleigh comes to rest
/// in the limit only, and creeps where a force below `F` pushes it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Friction {
    /// `F` (N).
    pub along: f64,
    /// `u_0` (m/s).
    pub smoothing: f64,
    /// `T` (N m).
    pub turning: f64,
    /// `omega_0` (rad/s).
    pub turning_smoothing: f64,
}

impl Friction {
    /// The friction `F` (N) along the blade, smoothed over the speed `u_0` (m/s), and the torque `T` (N m), smoothed over the turn rate
    /// `omega_0` (rad/s).
    ///
    /// # Errors
    /// [`SleighError::Negative`] names the force or the torque, [`SleighError::NotPositive`] what smooths it.
    pub fn new(along: f64, smoothing: f64, turning: f64, turning_smoothing: f64) -> Result<Self, SleighError> {
        Ok(Self {
            along: not_negative("along", along)?,
            smoothing: positive("smoothing", smoothing)?,
            turning: not_negative("turning", turning)?,
            turning_smoothing: positive("turning_smoothing", turning_smoothing)?,
        })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Friction {
    #[inline(always)]
    fn force<S: Scalar>(&self, _body: &B, _t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let (sin, cos) = q[2].sin_cos();
        let against = |rate: S, force: f64, smoothing: f64| (rate / smoothing).tanh() * -force;
        let push = against(cos * v[0] + sin * v[1], self.along, self.smoothing);
        let mut force = [S::zero(); N];
        let turn = against(v[2], self.turning, self.turning_smoothing);
        force[..3].copy_from_slice(&[push * cos, push * sin, turn]);
        Some(force)
    }
}

impl PushInOwnAxes for Friction {}
