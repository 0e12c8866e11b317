use crate::checks::finite;
use crate::{SleighBody, SleighError};
use lagrangian::{Effect, Scalar};

/// A uniform tangential gravity: `V = -m (g_x X + g_y Y)` at the centre of mass `C = (X, Y)`.
///
/// With `a = 0` the skate traces cycloids across the slope, and on the mean does not descend
/// (Neimark and Fufaev 1972, Dynamics of Nonholonomic Systems, chapter III).
#[derive(Debug, Clone, PartialEq)]
pub struct Slope {
    gravity: [f64; 2],
}

impl Slope {
    /// The slope with the tangential gravity `(g_x, g_y)` (m/s^2).
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn new(gravity: [f64; 2]) -> Result<Self, SleighError> {
        Ok(Self { gravity: finite("gravity", gravity)? })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Slope {
    #[inline(always)]
    fn has_force(&self) -> bool {
        false
    }

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, _t: S, q: &[S; N], _v: &[S; N]) -> Option<S> {
        let m = body.sleigh().mass();
        let [x, y] = body.centre(q);
        Some(x * (m * self.gravity[0]) + y * (m * self.gravity[1]))
    }

    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, _t: S, q: &[S; N]) -> lagrangian::EffectSlope<S, N> {
        let m = body.sleigh().mass();
        let force = self.gravity.map(|g| S::constant(m * g));
        lagrangian::EffectSlope::Known(body.at_centre(q, force))
    }
}
