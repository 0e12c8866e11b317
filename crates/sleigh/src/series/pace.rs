use super::coefficients::ORDER;
use lagrangian::linear::larger;
use lagrangian::{octaves, of_octaves, two_sum};

/// The term of the series that, with the one before it, limits the length of a step; the later terms are computed too late.
pub(crate) const LOOKED_AT: usize = ORDER - 2;
/// If this term is the tolerance to this power, terms that fall off evenly leave an error of the tolerance.
const POWER: f64 = LOOKED_AT as f64 / (ORDER + 1) as f64;
/// Power of the tolerance at which the last term may stand: `ORDER/(ORDER+1)`.
const LAST: f64 = ORDER as f64 / (ORDER + 1) as f64;
/// Octaves by which the last term may be larger.
const SLACK: f64 = 3.0;
/// Factor that shortens the step if the last term is larger still.
const SHORTER: f64 = 0.75;

/// How long steps may be, by the terms of their series.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeriesPace {
    /// The tolerance of a step in octaves; the error is in units of `1 + |(omega, u)|`.
    tolerance: f64,
}

impl SeriesPace {
    /// The pace for this error of a step, raised to at least `1e-31`, also if it is NaN.
    #[inline(always)]
    pub(crate) fn new(tolerance: f64) -> Self {
        Self { tolerance: octaves(tolerance.max(1e-31)) }
    }

    /// The longest step (s), positive or NaN, from the size of the velocities at its start and the largest coefficients of three terms:
    /// `LOOKED_AT`, the one before it, and the last.
    #[inline(always)]
    pub(crate) fn longest(&self, velocity: f64, [looked_at, before, last]: [f64; 3]) -> f64 {
        let size = octaves(1.0 + velocity);
        let allowed = POWER * self.tolerance + size;
        let by = |x: f64, k: usize| (allowed - octaves(x)) * (1.0 / k as f64);
        let mut full = of_octaves(by(looked_at, LOOKED_AT).min(by(before, LOOKED_AT - 1)));
        let most = of_octaves(LAST * self.tolerance + size + SLACK);
        while last * full.powi(ORDER as i32) > most {
            full *= SHORTER;
        }
        full
    }
}

/// The larger of `|omega|` and `|u|`.
#[inline(always)]
pub(crate) fn size(omega: f64, u: f64) -> f64 {
    larger(omega.abs(), u.abs())
}

/// An interval of time that is crossed step by step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interval {
    whole: f64,
    /// The sum of the steps made (s), with its rounding error.
    made: (f64, f64),
}

impl Interval {
    /// An interval of length `whole` (s), which may be negative.
    #[inline(always)]
    pub(crate) fn new(whole: f64) -> Self {
        Self { whole, made: (0.0, 0.0) }
    }

    /// Makes a step of at most `full` (s). Returns its signed length, and true for the last step. Returns `None` if `full` is NaN or
    /// rounding beside the interval.
    #[inline(always)]
    pub(crate) fn go_on(&mut self, full: f64) -> Option<(f64, bool)> {
        let rest = (self.whole - self.made.0) - self.made.1;
        if full >= rest.abs() {
            return Some((rest, true));
        }
        if full.is_nan() || full <= f64::EPSILON * self.whole.abs() {
            return None;
        }
        let h = full.copysign(self.whole);
        self.made = two_sum(self.made.0, self.made.1 + h);
        Some((h, false))
    }
    /// The sum of the steps made (s).
    #[inline(always)]
    pub(crate) fn made(&self) -> f64 {
        self.made.0
    }
}
