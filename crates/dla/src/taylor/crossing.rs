use super::series::{Equations, ORDER, Series};
use crate::StepError;
use crate::octaves::{octaves, of_octaves};
use crate::state::two_sum;
use lagrangian::OwnAxes;
use lagrangian::linear::larger;
use lagrangian::simd::{Four, FourKernel};

/// An interval to be crossed.
pub(super) struct Crossing {
    pub(super) axes: OwnAxes,
    /// `(omega, u, Y, X)` at its beginning.
    pub(super) start: [f64; 4],
    /// Its length (s).
    pub(super) whole: f64,
    /// The error of a step, in units of `1 + |(omega, u)|`: a positive number, and far below rounding is no better than that.
    pub(super) tolerance: f64,
}

/// Where it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossed {
    /// `(omega, u, Y, X)`.
    pub(super) end: [f64; 4],
    /// By how much the heading has turned (rad).
    pub(super) turn: f64,
}

/// The step is as long as this term and the one before allow, since the last ones come late.
const LOOKED_AT: usize = ORDER - 2;
/// Where they are of the size of the error's power of this, terms that fall off evenly leave the error.
const POWER: f64 = LOOKED_AT as f64 / (ORDER + 1) as f64;
/// And the last term has this power.
const LAST: f64 = ORDER as f64 / (ORDER + 1) as f64;
/// By how many octaves it may be larger.
const SLACK: f64 = 3.0;
/// Where it is larger still, the step is shortened by this factor.
const SHORTER: f64 = 0.75;
/// Steps within an interval before it is given up.
pub(super) const MAX_STEPS: u32 = 10_000_000;

impl FourKernel for Crossing {
    type Output = Result<Crossed, StepError>;

    #[inline(always)]
    fn run<F: Four>(self, zero: F) -> Self::Output {
        let equations = Equations::new(zero, &self.axes);
        let mut series = Series::new(zero);
        // Sums of many steps, with their rounding.
        let (mut z, mut made, mut turn) = (zero.of(&self.start), (0.0, 0.0), (0.0, 0.0));
        let tolerance = octaves(self.tolerance);
        for tries in 1..=MAX_STEPS {
            series.expand(&equations, z);
            let [omega, u, ..] = series.z[0].row();
            let size = octaves(1.0 + larger(omega.abs(), u.abs()));
            let allowed = POWER * tolerance + size;
            let longest = |k: usize| (allowed - octaves(series.z[k].largest())) * (1.0 / k as f64);
            let mut full = of_octaves(longest(LOOKED_AT).min(longest(LOOKED_AT - 1)));
            let (last, most) = (series.z[ORDER].largest(), of_octaves(LAST * tolerance + size + SLACK));
            while last * full.powi(ORDER as i32) > most {
                full *= SHORTER;
            }
            let rest = (self.whole - made.0) - made.1;
            let ends = full >= rest.abs();
            let h = if ends { rest } else { full.copysign(self.whole) };
            // Also where it is no number.
            if !ends && (full.is_nan() || full <= f64::EPSILON * self.whole.abs()) {
                return Err(StepError::Tolerance { tries, step: full });
            }
            let (next, by) = series.after(h);
            z = next;
            turn = two_sum(turn.0, turn.1 + by);
            if ends {
                return Ok(Crossed { end: z.row(), turn: turn.0 });
            }
            made = two_sum(made.0, made.1 + h);
        }
        Err(StepError::Tolerance { tries: MAX_STEPS, step: self.whole - made.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lagrangian::Origin;
    use lagrangian::simd::{in_fours, in_plain_fours};
    use proptest::prelude::*;

    proptest! {
        /// In registers and on plain numbers, to the last bit.
        #[test]
        fn registers_change_no_bit(
            start in proptest::array::uniform4(-3.0..3.0f64), lead in -1.0..1.0f64, share in 0.1..1.0f64,
            along in proptest::array::uniform2(-0.5..0.5f64), turning in proptest::array::uniform2(-0.5..0.5f64),
            whole in -2.0..2.0f64, exponent in -16..-2i32,
        ) {
            // Of another sign than the lead the gain would be that of no body, whose spin could grow without bounds.
            let gain = share * lead;
            let axes = OwnAxes { origin: Origin::Anywhere, inverse: [1.0; 2], lead, gain, along, turning };
            let crossing = || Crossing { axes, start, whole, tolerance: 10f64.powi(exponent) };
            let bits = |crossed: Crossed| (crossed.end.map(f64::to_bits), crossed.turn.to_bits());
            let (one, other) = (in_fours(crossing()).unwrap(), in_plain_fours(crossing()).unwrap());
            prop_assert_eq!(bits(one), bits(other));
        }
    }
}
