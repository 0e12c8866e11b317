use super::half_turn::half_turn;
use crate::Sleigh;
use dla::ClosedStepError;
use lagrangian::mul_add;

/// An error in `r` of this size is rounding.
const ROUNDING: f64 = 1e-17;

/// The equation for the mean spin `w` of a step, `f(w) = w (1 + k U) cos d - omega0 cos d = 0` with `U cos d = u0 + a w sin d`
/// and `d = h w/2`; here what of it does not change from step to step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpinEquation {
    /// `h/2`.
    pub(crate) half: f64,
    /// The offset of the mass.
    pub(crate) a: f64,
    /// `h m a / (2 J)`.
    pub(crate) k: f64,
    /// `1 + m a^2 / J`, by which the equation is more curved than a cosine is.
    bend: f64,
}

/// What the equation is at one spin, but for what depends on where the step begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpinPoint {
    pub(crate) w: f64,
    /// Sine and cosine of `d`.
    pub(crate) sin: f64,
    pub(crate) cos: f64,
    /// `a w sin d`, and its slope.
    pub(crate) across: f64,
    pub(crate) across_of_w: f64,
    /// `w (cos d + k a w sin d)`, and its slope.
    grown: f64,
    grown_of_w: f64,
}

impl SpinEquation {
    /// The equation of a step of length `h` (s).
    #[inline(always)]
    pub(crate) fn new(sleigh: &Sleigh, h: f64) -> Self {
        let (half, a, gain) = (0.5 * h, sleigh.offset(), sleigh.spin_gain());
        Self { half, a, k: half * gain, bend: mul_add(gain, a, 1.0) }
    }

    /// The equation for the ratio `r = w/unit`, which starts at one: `d = (h unit/2) r` and `a w = (a unit) r`.
    #[inline]
    pub(crate) fn in_units_of(self, unit: f64) -> Self {
        Self { half: self.half * unit, a: self.a * unit, ..self }
    }

    /// # Errors
    /// Where the blade turns by a right angle in half a step.
    #[inline(always)]
    pub(crate) fn at(&self, w: f64) -> Result<SpinPoint, ClosedStepError> {
        half_turn(self.half * w).map(|half_turn| self.point(w, half_turn))
    }

    /// As `at`, with known sine and cosine of the half turn.
    #[inline(always)]
    pub(crate) fn point(&self, w: f64, (sin, cos): (f64, f64)) -> SpinPoint {
        let Self { half, a, k, .. } = *self;
        let (across, across_of_w) = (a * (w * sin), a * mul_add(half * w, cos, sin));
        let growth = mul_add(k, across, cos);
        let grown_of_w = mul_add(k * w, across_of_w, mul_add(-half * w, sin, growth));
        SpinPoint { w, sin, cos, across, across_of_w, grown: w * growth, grown_of_w }
    }

    /// Newton's correction of the spin of a step that begins with `u0` and `omega0`.
    #[inline(always)]
    pub(crate) fn correction(&self, p: &SpinPoint, u0: f64, omega0: f64) -> f64 {
        let missing = mul_add(-self.k * p.w, u0, mul_add(p.cos, omega0, -p.grown));
        let slope = mul_add(self.k, u0, mul_add(self.half * p.sin, omega0, p.grown_of_w));
        missing / slope
    }

    /// Whether what a correction leaves is rounding: the equation is a straight line but for `C w^3` and smaller, with
    /// `C = (h/2)^2 (1 + m a^2 / J)`. A correction that is no number is not.
    ///
    /// The correction is taken as the angle by which it turns half a step: its own square overflows where the square of the step
    /// vanishes, in motions that are fast beyond all others.
    #[inline(always)]
    pub(crate) fn settles(&self, correction: f64) -> bool {
        let angle = self.half * correction;
        self.bend * (angle * angle) <= ROUNDING
    }

    /// A first guess of `w`, from `1 + k U` with `U = u0 + r^2 (a omega0 d + u0 d^2 / 2) + O(d^4)` and `r = w/omega0`.
    #[inline(always)]
    pub(crate) fn guess(&self, u0: f64, omega0: f64) -> f64 {
        let growth = 1.0 + self.k * u0;
        if growth <= 0.0 {
            return omega0;
        }
        let r = growth.recip();
        let (rr, d) = (r * r, self.half * omega0);
        omega0 * (r - self.k * (self.a * omega0 * d + 0.5 * u0 * d * d) * (rr * rr))
    }
}

const MAX_ITERATIONS: u32 = 30;

/// What a search has found.
pub(crate) struct FoundTurn {
    /// The spin, with sine and cosine of the half turn.
    pub(crate) w: f64,
    pub(crate) half_turn: (f64, f64),
    /// What is left to correct of it.
    pub(crate) correction: f64,
    /// The spin at the beginning.
    pub(crate) omega0: f64,
    pub(crate) iterations: u32,
}

/// The spin that Newton's method settles at from a first one, and after how many corrections.
pub(crate) fn settled(
    equation: &SpinEquation,
    first: f64,
    (u0, omega0): (f64, f64),
) -> Result<FoundTurn, ClosedStepError> {
    let mut point = equation.at(first)?;
    let (mut settled, mut iterations) = (false, 0);
    loop {
        let correction = equation.correction(&point, u0, omega0);
        // With one more: near a right angle what the last one leaves of the tangent is more than rounding.
        if settled {
            return Ok(FoundTurn { w: point.w, half_turn: (point.sin, point.cos), correction, omega0, iterations });
        }
        (settled, iterations) = (equation.settles(correction), iterations + 1);
        if !settled && (correction.is_nan() || iterations == MAX_ITERATIONS) {
            return Err(failure(equation.k * u0, iterations, correction / point.w));
        }
        point = equation.at(point.w + correction)?;
    }
}

#[cold]
fn failure(gain: f64, iterations: u32, correction: f64) -> ClosedStepError {
    if !gain.is_finite() {
        ClosedStepError::NotFinite { quantity: "h m a u / (2 J)" }
    } else if gain <= -1.0 {
        out_of_branch(gain)
    } else {
        ClosedStepError::IterationLimit { iterations, correction }
    }
}

#[cold]
pub(crate) fn out_of_branch(gain: f64) -> ClosedStepError {
    ClosedStepError::NoSolution {
        quantity: "the growth of the spin in half a step, -h m a u / (2 J),",
        value: -gain,
        bound: 1.0,
    }
}
