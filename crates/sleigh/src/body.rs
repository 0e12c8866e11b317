use crate::SleighError;
use crate::error::{finite, positive};
use lagrangian::Scalar;
use serde::Serialize;

/// The free Chaplygin sleigh.
///
/// `q = (x, y, theta)`: the blade's contact point `P = (x, y)` (m) and the heading `theta` (rad), with
/// `e = (cos theta, sin theta)` along the blade and `n = (-sin theta, cos theta)` across it. The centre of mass is
/// `C = P + a e`, the offset `a` signed: positive when the centre of mass is ahead of the blade.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sleigh {
    mass: f64,
    inertia: f64,
    offset: f64,
    #[serde(skip)]
    pivot_inertia: f64,
    #[serde(skip)]
    spin_gain: f64,
    /// `1/m` and `1/J`: a division takes as long as a dozen products.
    #[serde(skip)]
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

/// A body that is a sleigh, perhaps with more coordinates or constraints: its first three coordinates are `(x, y, theta)`.
pub trait SleighBody {
    /// Whether it is the sleigh and nothing more.
    const ALONE: bool = false;

    /// The sleigh.
    fn sleigh(&self) -> &Sleigh;

    /// The centre of mass `C = P + a e` (m).
    #[inline(always)]
    fn centre<S: Scalar, const N: usize>(&self, q: &[S; N]) -> [S; 2] {
        let (sin, cos) = q[2].sin_cos();
        let a = self.sleigh().offset();
        [q[0] + cos * a, q[1] + sin * a]
    }

    /// The generalised force of a force at the centre of mass (N).
    #[inline(always)]
    fn at_centre<S: Scalar, const N: usize>(&self, q: &[S; N], [fx, fy]: [S; 2]) -> [S; N] {
        let (sin, cos) = q[2].sin_cos();
        let torque = (cos * fy - sin * fx) * self.sleigh().offset();
        let mut force = [S::zero(); N];
        force[..3].copy_from_slice(&[fx, fy, torque]);
        force
    }
}

impl SleighBody for Sleigh {
    const ALONE: bool = true;

    #[inline(always)]
    fn sleigh(&self) -> &Sleigh {
        self
    }
}

/// A state of the sleigh in the words of a scene: position and heading of the blade, and the two admissible velocities.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct SleighState {
    /// Position of the blade's contact point (m).
    pub x: f64,
    /// Position of the blade's contact point (m).
    pub y: f64,
    /// Heading `theta`, with its full turns (rad).
    pub heading: f64,
    /// Forward speed `u` of the blade (m/s).
    pub speed: f64,
    /// Turn rate `omega` (rad/s).
    pub turn_rate: f64,
}

impl SleighState {
    /// Coordinates `(x, y, theta)` and velocities `(u cos theta, u sin theta, omega)`.
    #[must_use]
    pub fn to_coordinates(&self) -> ([f64; 3], [f64; 3]) {
        let (sin, cos) = self.heading.sin_cos();
        ([self.x, self.y, self.heading], [self.speed * cos, self.speed * sin, self.turn_rate])
    }

    /// The state of the given coordinates and velocities; `speed` is the velocity's component along the blade.
    #[must_use]
    pub fn from_coordinates(q: &[f64; 3], v: &[f64; 3]) -> Self {
        let (sin, cos) = q[2].sin_cos();
        Self { x: q[0], y: q[1], heading: q[2], speed: v[0] * cos + v[1] * sin, turn_rate: v[2] }
    }
}
