use super::Memory;
use super::differences::after_next;
use super::half_turn::series;
use super::heading::Heading;
use lagrangian::from_fn;

/// What a step of a map with `P` unknowns, the last of which is the mean spin, leaves to the next, which changes it in place.
#[derive(Debug)]
pub(crate) struct Foreseen<'a, const P: usize, const KEPT: usize, const N: usize> {
    /// Sine and cosine of the half turn of the unknowns that are expected here, these, and those expected one step later; then the
    /// last ones and their first backward differences, `KEPT` of each in all; then what is the map's own affair. They are read where
    /// they are used, so that until then they need no other place.
    pub(crate) numbers: &'a mut [f64; N],
    pub(crate) heading: Heading<'a>,
}

impl<'a, const P: usize, const KEPT: usize, const N: usize> Foreseen<'a, P, KEPT, N> {
    /// What the step before has left to one that begins at this heading.
    #[inline(always)]
    pub(crate) fn of(memory: &'a mut Memory, heading: f64) -> Self {
        // The heading first: behind the differences, its sine would be stored with them, and its cosine be waited for, which is read
        // with it.
        let (direction, numbers) = memory.parts();
        Self { numbers, heading: Heading::at(heading, direction) }
    }

    /// The unknowns that are expected.
    #[inline(always)]
    pub(crate) fn expected(&self) -> [f64; P] {
        from_fn(|i| self.numbers[2 + i])
    }

    /// Sine and cosine of their half turn.
    #[inline(always)]
    pub(crate) fn half_turn(&self) -> [f64; 2] {
        [self.numbers[0], self.numbers[1]]
    }

    /// Leaves to the next step what one of length `h` with the unknowns `x` does.
    ///
    /// The unknowns are expected two steps after the last ones that they are expected from, so that sine and cosine of their half turn
    /// are there before the step between has ended.
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
