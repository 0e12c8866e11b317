use super::pace::{Interval, LOOKED_AT, Pace, size};
use super::series::{Equations, ORDER, Series};
use crate::StepError;
use crate::state::two_sum;
use lagrangian::OwnAxes;
use lagrangian::simd::{Four, FourKernel};

/// An interval to be crossed.
pub(crate) struct Crossing {
    pub(crate) axes: OwnAxes,
    /// `(omega, u, Y, X)` at its beginning.
    pub(crate) start: [f64; 4],
    /// Its length (s).
    pub(crate) whole: f64,
    /// The error of a step, in units of `1 + |(omega, u)|`.
    pub(crate) tolerance: f64,
}

/// Where it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossed {
    /// `(omega, u, Y, X)`.
    pub(crate) end: [f64; 4],
    /// By how much the heading has turned (rad).
    pub(crate) turn: f64,
}

/// Steps within an interval before it is given up.
pub(crate) const MAX_STEPS: u32 = 10_000_000;

impl FourKernel for Crossing {
    type Output = Result<Crossed, StepError>;

    #[inline(always)]
    fn run<F: Four>(self, zero: F) -> Self::Output {
        let equations = Equations::new(zero, &self.axes);
        let mut series = Series::new(zero);
        // The turn is a sum of many, with its rounding.
        let (mut z, mut turn, mut interval) = (zero.of(&self.start), (0.0, 0.0), Interval::new(self.whole));
        let (pace, mut full) = (Pace::new(self.tolerance), f64::NAN);
        for tries in 1..=MAX_STEPS {
            series.expand(&equations, z);
            let [omega, u, ..] = series.z[0].row();
            let terms = [LOOKED_AT, LOOKED_AT - 1, ORDER].map(|k| series.z[k].largest());
            full = pace.longest(size(omega, u), terms);
            let Some((h, ends)) = interval.go_on(full) else { return Err(StepError::Tolerance { tries, step: full }) };
            let (next, by) = series.after(h);
            z = next;
            turn = two_sum(turn.0, turn.1 + by);
            if ends {
                return Ok(Crossed { end: z.row(), turn: turn.0 });
            }
        }
        Err(StepError::Tolerance { tries: MAX_STEPS, step: full })
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
