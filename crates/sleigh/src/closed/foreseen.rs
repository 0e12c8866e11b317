use super::Memory;
use super::differences::after_next;
use super::half_turn::series;
use super::heading::Heading;
use lagrangian::from_fn;

/// The numbers that a step leaves to the next, which changes them in place. The map has `P` unknowns, the last of which is the mean spin.
#[derive(Debug)]
pub(crate) struct Foreseen<'a, const P: usize, const KEPT: usize, const N: usize> {
    /// In this order: sine and cosine of the expected half turn, the unknowns expected in this step, the unknowns expected one step
    /// later, `KEPT` rows of the last unknowns and their backward differences, and numbers of the map's own. They are read in place.
    pub(crate) numbers: &'a mut [f64; N],
    pub(crate) heading: Heading<'a>,
}

impl<'a, const P: usize, const KEPT: usize, const N: usize> Foreseen<'a, P, KEPT, N> {
    /// The numbers left by the step before, for a step that begins at this heading.
    #[inline(always)]
    pub(crate) fn of(memory: &'a mut Memory, heading: f64) -> Self {
        // The heading first: behind the differences, its sine would be stored with them, and its cosine be waited for, which is read
        // with it.
        let (direction, numbers) = memory.parts();
        Self { numbers, heading: Heading::at(heading, direction) }
    }

    /// The expected unknowns.
    #[inline(always)]
    pub(crate) fn expected(&self) -> [f64; P] {
        from_fn(|i| self.numbers[2 + i])
    }

    /// Sine and cosine of the expected half turn.
    #[inline(always)]
    pub(crate) fn half_turn(&self) -> [f64; 2] {
        [self.numbers[0], self.numbers[1]]
    }

    /// Stores the numbers for the next step, after a step of length `h` with the unknowns `x`.
    ///
    /// The unknowns are extrapolated by two steps, so that sine and cosine of their half turn are computed while the step between is
    /// still running.
    #[inline(always)]
    pub(crate) fn leave(&mut self, h: f64, x: [f64; P]) {
        let (expected, differences) = self.numbers[..2 + (2 + KEPT) * P].split_at_mut(2 + 2 * P);
        for i in 0..P {
            expected[2 + i] = expected[2 + P + i];
        }
        (expected[0], expected[1]) = series(0.5 * h * expected[1 + P]);
        expected[2 + P..].copy_from_slice(&after_next(x, differences));
    }
}
