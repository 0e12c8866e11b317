//! Forces that are functions of time.

use crate::series::{OwnPush, PushInOwnAxes};
use crate::{Sleigh, SleighBody, SleighError, TimeFunction};
use lagrangian::{Effect, Piecewise, Scalar};
use serde::Serialize;

/// A force `F(t)` along the blade at its contact point (N).
///
/// A constant one makes `m/2 u^2 + J/2 omega^2 + (F J / (m a)) ln|omega|` an integral of the motion; a backward one keeps
/// the sleigh turning around for ever.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Thrust {
    /// `F(t)` (N).
    pub force: TimeFunction,
}

impl Thrust {
    /// The thrust `F(t)` (N).
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn new(force: impl Into<TimeFunction>) -> Result<Self, SleighError> {
        Ok(Self { force: force.into().finite("force")? })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Thrust {
    #[inline(always)]
    fn force<S: Scalar>(&self, _body: &B, t: S, q: &[S; N], _v: &[S; N]) -> Option<[S; N]> {
        let (sin, cos) = q[2].sin_cos();
        let push = self.force.value(t);
        let mut force = [S::zero(); N];
        force[..2].copy_from_slice(&[push * cos, push * sin]);
        Some(force)
    }
}

impl Piecewise for Thrust {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.force.jumps(from, to)
    }
    fn piece(&self, t: f64) -> Self {
        Self { force: self.force.piece(t) }
    }
}

impl PushInOwnAxes for Thrust {
    /// Of a constant force.
    fn in_own_axes(&self, _sleigh: &Sleigh) -> Option<OwnPush> {
        match self.force {
            TimeFunction::Constant(force) => Some(OwnPush { along: [force, 0.0], ..OwnPush::NOTHING }),
            _ => None,
        }
    }
}

/// A torque `tau(t)` on the heading (N m).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Torque {
    /// `tau(t)` (N m).
    pub torque: TimeFunction,
}

impl Torque {
    /// The torque `tau(t)` (N m).
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn new(torque: impl Into<TimeFunction>) -> Result<Self, SleighError> {
        Ok(Self { torque: torque.into().finite("torque")? })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Torque {
    #[inline(always)]
    fn force<S: Scalar>(&self, _body: &B, t: S, _q: &[S; N], _v: &[S; N]) -> Option<[S; N]> {
        let torque = self.torque.value(t);
        let mut force = [S::zero(); N];
        force[2] = torque;
        Some(force)
    }
}

impl Piecewise for Torque {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.torque.jumps(from, to)
    }
    fn piece(&self, t: f64) -> Self {
        Self { torque: self.torque.piece(t) }
    }
}

impl PushInOwnAxes for Torque {
    /// Of a constant torque.
    fn in_own_axes(&self, _sleigh: &Sleigh) -> Option<OwnPush> {
        match self.torque {
            TimeFunction::Constant(torque) => Some(OwnPush { turning: [torque, 0.0], ..OwnPush::NOTHING }),
            _ => None,
        }
    }
}
