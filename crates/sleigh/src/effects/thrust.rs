use crate::series::{OwnPush, PushInOwnAxes};
use crate::{SleighBody, SleighError, TimeFunction};
use lagrangian::{Effect, Piecewise, Scalar};

/// A force `F(t)` along the blade at its contact point (N).
///
/// A constant one makes `m/2 u^2 + J/2 omega^2 + (F J / (m a)) ln|omega|` an integral of the motion; a backward one keeps
/// the sleigh turning around for ever.
#[derive(Debug, Clone, PartialEq)]
pub struct Thrust {
    force: TimeFunction,
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

/// Where it is constant.
impl<B> PushInOwnAxes<B> for Thrust {
    fn in_own_axes(&self, _body: &B) -> Option<OwnPush> {
        match self.force {
            TimeFunction::Constant(force) => Some(OwnPush { along: [force, 0.0], ..OwnPush::NOTHING }),
            _ => None,
        }
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
