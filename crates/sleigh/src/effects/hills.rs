use crate::checks::{finite, positive};
use crate::{SleighBody, SleighError};
use lagrangian::{Effect, EffectSlope, Scalar};

/// One Gaussian hill, or hollow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hill {
    /// Height `h` (J); negative for a hollow.
    pub height: f64,
    /// Its middle (m).
    pub x: f64,
    /// Its middle (m).
    pub y: f64,
    /// Width `s` (m).
    pub width: f64,
}

/// A landscape of hills: `V = sum_i h_i exp(-((X - x_i)^2 + (Y - y_i)^2) / (2 s_i^2))` at the centre of mass `C = (X, Y)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Hills {
    hills: Vec<Hill>,
}

impl Hills {
    /// The landscape of these hills.
    ///
    /// # Errors
    /// [`SleighError`] names the quantity that is not finite, or the width that is not positive.
    pub fn new(hills: Vec<Hill>) -> Result<Self, SleighError> {
        for hill in &hills {
            finite("height", [hill.height])?;
            finite("the middle of a hill", [hill.x, hill.y])?;
            positive("width", hill.width)?;
        }
        Ok(Self { hills })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for Hills {
    #[inline(always)]
    fn has_force(&self) -> bool {
        false
    }

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, _t: S, q: &[S; N], _v: &[S; N]) -> Option<S> {
        let [x, y] = body.centre(q);
        let mut potential = S::zero().carried_as(x);
        for hill in &self.hills {
            // Scaled before it is squared: a narrow hill has a square that no f64 holds.
            let scale = hill.width.recip();
            let (dx, dy) = ((x - hill.x) * scale, (y - hill.y) * scale);
            potential += ((dx * dx + dy * dy) * -0.5).exp() * hill.height;
        }
        Some(-potential)
    }

    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, _t: S, q: &[S; N]) -> EffectSlope<S, N> {
        let [x, y] = body.centre(q);
        let mut force = [S::zero().carried_as(x); 2];
        for hill in &self.hills {
            let scale = hill.width.recip();
            let (dx, dy) = ((x - hill.x) * scale, (y - hill.y) * scale);
            let steepness = ((dx * dx + dy * dy) * -0.5).exp() * (hill.height * scale);
            force[0] += steepness * dx;
            force[1] += steepness * dy;
        }
        EffectSlope::Known(body.at_centre(q, force))
    }
}
