use crate::series::{OwnPush, PushInOwnAxes};
use crate::{SleighBody, SleighError, TimeFunction};
use lagrangian::{Effect, Piecewise, Scalar};

/// A torque `tau(t)` on the heading (N m).
#[derive(Debug, Clone, PartialEq)]
pub struct Torque {
    torque: TimeFunction,
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

/// Where it is constant.
impl<B> PushInOwnAxes<B> for Torque {
    fn in_own_axes(&self, _body: &B) -> Option<OwnPush> {
        match self.torque {
            TimeFunction::Constant(torque) => Some(OwnPush { turning: [torque, 0.0], ..OwnPush::NOTHING }),
            _ => None,
        }
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
