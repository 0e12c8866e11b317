use lagrangian::sin_cos_wrapped;

/// By how much an angle may differ from the one that a direction was turned to (rad): a few roundings.
const SAME: f64 = 23.5 * f64::EPSILON;
/// By how much less after every step: nothing is left after eight, so that what rounding does to a direction does not add up.
const WORN: f64 = 3.0 * f64::EPSILON;

/// The direction of the blade at an angle. It is turned along with every step, and its sine and cosine are worked out anew after some.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Heading {
    /// The angle, to rounding: that of a state is a sum with a rest, which is not known here.
    angle: f64,
    sin: f64,
    cos: f64,
    /// By how much the angle of a state may differ from it.
    slack: f64,
}

impl Heading {
    /// As many numbers it is.
    pub(crate) const SIZE: usize = 4;

    /// The direction at an angle.
    #[inline(always)]
    pub(crate) fn of(angle: f64) -> Self {
        let (sin, cos) = sine_and_cosine(angle);
        Self { angle, sin, cos, slack: SAME }
    }

    /// The direction at the angle where a step begins: that at the end of the step before, if this is where that ended.
    #[inline(always)]
    pub(crate) fn remembered(&[angle, sin, cos, slack]: &[f64; Self::SIZE], q: f64) -> Self {
        if (q - angle).abs() <= slack { Self { angle: q, sin, cos, slack } } else { Self::of(q) }
    }

    /// Sine and cosine.
    #[inline(always)]
    pub(crate) fn both(&self) -> [f64; 2] {
        [self.sin, self.cos]
    }

    /// What is remembered of it where a step has turned it by an angle, to this sine and cosine.
    #[inline(always)]
    pub(crate) fn turned(&self, turn: f64, [sin, cos]: [f64; 2]) -> [f64; Self::SIZE] {
        [self.angle + turn, sin, cos, self.slack - WORN]
    }
}

// A call, since few steps come here.
#[cold]
#[inline(never)]
fn sine_and_cosine(angle: f64) -> (f64, f64) {
    sin_cos_wrapped(angle)
}
