use crate::SleighError;
use crate::checks::{finite, positive};

/// The free Chaplygin sleigh.
///
/// `q = (x, y, theta)`: the blade's contact point `P = (x, y)` (m) and the heading `theta` (rad), with
/// `e = (cos theta, sin theta)` along the blade and `n = (-sin theta, cos theta)` across it. The centre of mass is
/// `C = P + a e`, the offset `a` signed: positive when the centre of mass is ahead of the blade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sleigh {
    mass: f64,
    inertia: f64,
    offset: f64,
    pivot_inertia: f64,
    spin_gain: f64,
    /// `1/m` and `1/J`: a division takes as long as a dozen products.
    inverse: [f64; 2],
}

impl Sleigh {
    /// A sleigh of mass `m` (kg), moment of inertia `I` (kg m^2) about the centre of mass and offset `a` (m).
    ///
    /// # Errors
    /// [`SleighError`] names the parameter that is not finite, or that must be positive and is not.
    pub fn new(mass: f64, inertia: f64, offset: f64) -> Result<Self, SleighError> {
        positive("mass", mass)?;
        positive("inertia", inertia)?;
        finite("offset", [offset])?;
        let pivot_inertia = inertia + mass * offset * offset;
        finite("inertia about the blade, I + m a^2,", [pivot_inertia])?;
        let (spin_gain, inverse) = (mass * offset / pivot_inertia, [mass.recip(), pivot_inertia.recip()]);
        Ok(Self { mass, inertia, offset, pivot_inertia, spin_gain, inverse })
    }

    /// Mass `m` (kg).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Moment of inertia `I` about the centre of mass (kg m^2).
    #[must_use]
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Signed distance `a` of the centre of mass ahead of the blade (m).
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Moment of inertia `J = I + m a^2` about the blade's contact point (kg m^2).
    #[must_use]
    pub fn pivot_inertia(&self) -> f64 {
        self.pivot_inertia
    }

    /// `1/m` (1/kg) and `1/J` (1/(kg m^2)).
    #[must_use]
    pub(crate) fn inverse(&self) -> [f64; 2] {
        self.inverse
    }

    /// The rate `c = m a / J` (1/m) of `omega' = -c u omega`, by which the spin dies out or grows.
    #[must_use]
    pub fn spin_gain(&self) -> f64 {
        self.spin_gain
    }
}
