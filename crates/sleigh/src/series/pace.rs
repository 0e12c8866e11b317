use super::coefficients::ORDER;
use lagrangian::linear::larger;
use lagrangian::{octaves, of_octaves, two_sum};

/// A step is as long as this term and the one before allow, since the last ones come late.
pub(crate) const LOOKED_AT: usize = ORDER - 2;
/// Where they are of the size of the error's power of this, terms that fall off evenly leave the error.
const POWER: f64 = LOOKED_AT as f64 / (ORDER + 1) as f64;
/// And the last term has this power.
const LAST: f64 = ORDER as f64 / (ORDER + 1) as f64;
/// By how many octaves it may be larger.
const SLACK: f64 = 3.0;
/// Where it is larger still, the step is shortened by this factor.
const SHORTER: f64 = 0.75;

/// How long steps may be, by the terms of their series.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeriesPace {
    /// The octaves of the error of a step, in units of `1 + |(omega, u)|`.
    tolerance: f64,
}

impl SeriesPace {
    /// At this error of a step, which is taken to be no less than `1e-31`, also where it is no number.
    #[inline(always)]
    pub(crate) fn new(tolerance: f64) -> Self {
        Self { tolerance: octaves(tolerance.max(1e-31)) }
    }

    /// The length of a step (s) with velocities of this size at its beginning and largest coefficients of these sizes: those of the
    /// term that is looked at, of the one before, and of the last. It is positive, or no number.
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

/// The size of velocities.
#[inline(always)]
pub(crate) fn size(omega: f64, u: f64) -> f64 {
    larger(omega.abs(), u.abs())
}

/// An interval of time that is crossed step by step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interval {
    whole: f64,
    /// The sum of the steps, with its rounding.
    made: (f64, f64),
}

impl Interval {
    /// Of this length (s), which may be negative.
    #[inline(always)]
    pub(crate) fn new(whole: f64) -> Self {
        Self { whole, made: (0.0, 0.0) }
    }

    /// Goes on by a step that may be as long as `full`: its length, and whether it is the last. None where it would be nothing beside
    /// the interval, or no number.
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
    /// How far it has come (s).
    #[inline(always)]
    pub(crate) fn made(&self) -> f64 {
        self.made.0
    }
}
