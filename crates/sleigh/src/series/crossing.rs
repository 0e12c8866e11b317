use super::OwnAxes;
use super::coefficients::{ORDER, SeriesEquations, SeriesTerms};
use super::pace::{Interval, LOOKED_AT, SeriesPace, size};
use dla::StepError;
use lagrangian::simd::{Four, FourKernel};
use lagrangian::two_sum;
use std::ops::ControlFlow;

/// An interval to be crossed.
pub(crate) struct SeriesCrossing<'a, See> {
    pub(crate) axes: OwnAxes,
    /// `(omega, u, Y, X)` at the start of the interval.
    pub(crate) start: [f64; 4],
    /// Length of the interval (s).
    pub(crate) whole: f64,
    /// The error of a step, in units of `1 + |(omega, u)|`.
    pub(crate) tolerance: f64,
    /// Fractions of every step at which `see` is called too.
    pub(crate) within: &'a [f64],
    /// Called with the time since the start of the interval (s) and the state: at the `within` fractions of each step, and at the end of
    /// every step but the last. A `Break` at the end of a step ends the crossing there.
    pub(crate) see: See,
}

/// The state after a crossing, or at a point of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SeriesEnd {
    /// `(omega, u, Y, X)`.
    pub(crate) end: [f64; 4],
    /// By how much the heading has turned (rad).
    pub(crate) turn: f64,
}

/// Maximum number of steps in an interval.
pub(crate) const MAX_STEPS: u32 = 10_000_000;

impl<See: FnMut(f64, SeriesEnd) -> ControlFlow<()>> FourKernel for SeriesCrossing<'_, See> {
    type Output = Result<SeriesEnd, StepError>;

    #[inline(always)]
    fn run<F: Four>(self, zero: F) -> Self::Output {
        if self.axes.is_damped() { self.crossed::<F, true>(zero) } else { self.crossed::<F, false>(zero) }
    }
}

impl<See: FnMut(f64, SeriesEnd) -> ControlFlow<()>> SeriesCrossing<'_, See> {
    #[inline(always)]
    fn crossed<F: Four, const DAMPED: bool>(mut self, zero: F) -> Result<SeriesEnd, StepError> {
        let equations = SeriesEquations::new(zero, &self.axes);
        let mut series = SeriesTerms::new(zero);
        // The turn is a sum of many, with its rounding.
        let (mut z, mut turn, mut interval) = (zero.of(&self.start), (0.0, 0.0), Interval::new(self.whole));
        let (pace, mut full) = (SeriesPace::new(self.tolerance), f64::NAN);
        for tries in 1..=MAX_STEPS {
            series.expand::<DAMPED>(&equations, z);
            let [omega, u, ..] = series.z[0].row();
            let terms = [LOOKED_AT, LOOKED_AT - 1, ORDER].map(|k| series.z[k].largest());
            full = pace.longest(size(omega, u), terms);
            let begun = interval.made();
            let Some((h, ends)) = interval.go_on(full) else { return Err(StepError::Tolerance { tries, step: full }) };
            for part in self.within {
                let (inside, by) = series.after(part * h);
                let _ = (self.see)(begun + part * h, SeriesEnd { end: inside.row(), turn: turn.0 + by });
            }
            let (next, by) = series.after(h);
            z = next;
            turn = two_sum(turn.0, turn.1 + by);
            if ends || (self.see)(interval.made(), SeriesEnd { end: z.row(), turn: turn.0 }).is_break() {
                return Ok(SeriesEnd { end: z.row(), turn: turn.0 });
            }
        }
        Err(StepError::Tolerance { tries: MAX_STEPS, step: full })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lagrangian::simd::{in_fours, in_plain_fours};
    use proptest::prelude::*;

    /// Keeps what it is shown.
    fn keep(seen: &mut Vec<(f64, SeriesEnd)>) -> impl FnMut(f64, SeriesEnd) -> ControlFlow<()> + '_ {
        |t, crossed| {
            seen.push((t, crossed));
            ControlFlow::Continue(())
        }
    }

    proptest! {
        /// In registers and on plain numbers, to the last bit.
        #[test]
        fn registers_change_no_bit(
            start in proptest::array::uniform4(-3.0..3.0f64), lead in -1.0..1.0f64, share in 0.1..1.0f64,
            along in proptest::array::uniform2(-0.5..0.5f64), turning in proptest::array::uniform2(-0.5..0.5f64),
            drag in proptest::array::uniform2(0.0..0.5f64), damped: bool, whole in -2.0..2.0f64, exponent in -16..-2i32,
        ) {
            // Of another sign than the lead the gain would be that of no body, whose spin could grow without bounds.
            let gain = share * lead;
            let damping = if damped { drag } else { [0.0; 2] };
            let axes = OwnAxes { center: None, inverse: [1.0; 2], lead, gain, along, turning, damping };
            let bits = |crossed: SeriesEnd| (crossed.end.map(f64::to_bits), crossed.turn.to_bits());
            let mut seen = [Vec::new(), Vec::new()];
            let [one, other] = &mut seen;
            let crossing = |seen| SeriesCrossing { axes, start, whole, tolerance: 10f64.powi(exponent), within: &[0.3], see: keep(seen) };
            let (one, other) = (in_fours(crossing(one)).unwrap(), in_plain_fours(crossing(other)).unwrap());
            prop_assert_eq!(bits(one), bits(other));
            let [one, other] = seen.map(|seen| seen.iter().map(|(t, at)| (t.to_bits(), bits(*at))).collect::<Vec<_>>());
            prop_assert_eq!(one, other);
        }
    }
}
