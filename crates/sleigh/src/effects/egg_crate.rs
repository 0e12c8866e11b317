use crate::checks::finite;
use crate::{SleighBody, SleighError};
use lagrangian::{Effect, EffectSlope, Scalar};

/// A periodic landscape: `V = V_0 (cos(k_x X) + cos(k_y Y))` at the centre of mass `C = (X, Y)`.
///
/// With `a != 0` its chaotic motions contract phase space and settle on a strange attractor.
#[derive(Debug, Clone, PartialEq)]
pub struct EggCrate {
    height: f64,
    wave_number: [f64; 2],
}

impl EggCrate {
    /// The landscape of height `V_0` (J) and wave numbers `(k_x, k_y)` (1/m).
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn new(height: f64, wave_number: [f64; 2]) -> Result<Self, SleighError> {
        let [height] = finite("height", [height])?;
        Ok(Self { height, wave_number: finite("wave_number", wave_number)? })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for EggCrate {
    #[inline(always)]
    fn has_force(&self) -> bool {
        false
    }

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, _t: S, q: &[S; N], _v: &[S; N]) -> Option<S> {
        let [x, y] = body.centre(q);
        Some(((x * self.wave_number[0]).cos() + (y * self.wave_number[1]).cos()) * -self.height)
    }

    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, _t: S, q: &[S; N]) -> EffectSlope<S, N> {
        let ([x, y], [kx, ky]) = (body.centre(q), self.wave_number);
        let force = [(x * kx).sin() * (kx * self.height), (y * ky).sin() * (ky * self.height)];
        EffectSlope::Known(body.at_centre(q, force))
    }
}
