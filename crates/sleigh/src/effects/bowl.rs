use crate::checks::finite;
use crate::series::{OwnPush, PushInOwnAxes};
use crate::{SleighBody, SleighError};
use lagrangian::{Effect, EffectSlope, Scalar};

/// A quadratic well: `V = k_x/2 (X - c_x)^2 + k_y/2 (Y - c_y)^2` at the centre of mass `C = (X, Y)`.
///
/// One stiffness zero makes a valley, a negative one a ridge. The motion in a valley goes from regular to chaotic as the
/// energy grows (Kuznetsov 2019, arXiv 1909.01130).
#[derive(Debug, Clone, PartialEq)]
pub struct Bowl {
    stiffness: [f64; 2],
    center: [f64; 2],
}

impl Bowl {
    /// The well of these stiffnesses (N/m) about the point `center` (m).
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn new(stiffness: [f64; 2], center: [f64; 2]) -> Result<Self, SleighError> {
        Ok(Self { stiffness: finite("stiffness", stiffness)?, center: finite("center", center)? })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Bowl {
    #[inline(always)]
    fn has_force(&self) -> bool {
        false
    }

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, _t: S, q: &[S; N], _v: &[S; N]) -> Option<S> {
        let [x, y] = body.centre(q);
        let (x, y) = (x - self.center[0], y - self.center[1]);
        Some(-(x * x * (0.5 * self.stiffness[0]) + y * y * (0.5 * self.stiffness[1])))
    }

    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, _t: S, q: &[S; N]) -> EffectSlope<S, N> {
        let [x, y] = body.centre(q);
        let force = [(x - self.center[0]) * -self.stiffness[0], (y - self.center[1]) * -self.stiffness[1]];
        EffectSlope::Known(body.at_centre(q, force))
    }
}

/// Where it is round: `-k (X + a, Y)` at the centre of mass.
impl<B: SleighBody> PushInOwnAxes<B> for Bowl {
    fn in_own_axes(&self, body: &B) -> Option<OwnPush> {
        let [k, a] = [self.stiffness[0], body.sleigh().offset()];
        let round = k.to_bits() == self.stiffness[1].to_bits();
        round.then_some(OwnPush {
            center: Some(self.center),
            along: [-k * a, -k],
            turning: [0.0, -k * a],
            ..OwnPush::NOTHING
        })
    }
}
