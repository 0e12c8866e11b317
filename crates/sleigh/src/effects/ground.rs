//! Potentials of the ground at the centre of mass.

use crate::error::{finite, positive};
use crate::series::{OwnPush, PushInOwnAxes};
use crate::{Sleigh, SleighBody, SleighError};
use lagrangian::{Effect, EffectSlope, Scalar};
use serde::Serialize;

/// A uniform tangential gravity: `V = -m (g_x X + g_y Y)` at the centre of mass `C = (X, Y)`.
///
/// With `a = 0` the skate traces cycloids across the slope, and on the mean does not descend
/// (Neimark and Fufaev 1972, Dynamics of Nonholonomic Systems, chapter III).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Slope {
    /// The tangential gravity (m/s^2).
    pub gravity: [f64; 2],
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
    fn slope<S: Scalar>(&self, body: &B, _t: S, q: &[S; N]) -> EffectSlope<S, N> {
        let m = body.sleigh().mass();
        let force = self.gravity.map(|g| S::constant(m * g));
        EffectSlope::Known(body.at_centre(q, force))
    }
}

impl PushInOwnAxes for Slope {}

/// A quadratic well: `V = k_x/2 (X - c_x)^2 + k_y/2 (Y - c_y)^2` at the centre of mass `C = (X, Y)`.
///
/// One stiffness zero makes a valley, a negative one a ridge. The motion in a valley goes from regular to chaotic as the
/// energy grows (Kuznetsov 2019, arXiv 1909.01130).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bowl {
    /// `k_x` and `k_y` (N/m).
    pub stiffness: [f64; 2],
    /// The lowest point (m).
    pub center: [f64; 2],
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

impl PushInOwnAxes for Bowl {
    /// Of a round bowl: `-k (X + a, Y)` at the centre of mass.
    fn in_own_axes(&self, sleigh: &Sleigh) -> Option<OwnPush> {
        let [k, a] = [self.stiffness[0], sleigh.offset()];
        let round = k.to_bits() == self.stiffness[1].to_bits();
        round.then_some(OwnPush {
            center: Some(self.center),
            along: [-k * a, -k],
            turning: [0.0, -k * a],
            ..OwnPush::NOTHING
        })
    }
}

/// A periodic landscape: `V = V_0 (cos(k_x X) + cos(k_y Y))` at the centre of mass `C = (X, Y)`.
///
/// With `a != 0` its chaotic motions contract phase space and settle on a strange attractor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EggCrate {
    /// `V_0` (J).
    pub height: f64,
    /// `k_x` and `k_y` (1/m).
    pub wave_number: [f64; 2],
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

impl PushInOwnAxes for EggCrate {}

/// One Gaussian hill, or hollow.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hills {
    /// The hills.
    pub hills: Vec<Hill>,
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

impl PushInOwnAxes for Hills {}
