use crate::differences::after_next;
use crate::half_turn::series;
use crate::heading::{Heading, NO_HEADING};
use lagrangian::Memory;

/// As many differences of the spins are kept, with the last one itself.
const KEPT: usize = 6;
/// Numbers before them.
const EXPECTED: usize = 4;
const SIZE: usize = EXPECTED + KEPT;
/// Tells these numbers, in this order, from those of other maps and orders: a checkpoint may be older.
const KIND: f64 = 5.0;

/// What a step of the closed map leaves to the next, which changes it in place.
#[derive(Debug)]
pub(crate) struct SpinMemory<'a> {
    /// Sine and cosine of the half turn of the spin that is expected here, that spin, and the one expected one step later; then the
    /// last spin and its first backward differences. They are read where they are used, so that until then they need no other place.
    numbers: &'a mut [f64; SIZE],
    pub(crate) heading: Heading<'a>,
}

impl<'a> SpinMemory<'a> {
    /// What steps of length `h` have left to one that begins at this heading; before a first one nothing, as after many of the spin
    /// `w`.
    #[inline(always)]
    pub(crate) fn of(memory: &'a mut Memory, h: f64, (heading, w): (f64, f64)) -> Self {
        if !memory.is_of(h, KIND) {
            begin(memory, h, w);
        }
        let (direction, numbers) = memory.parts();
        Self { numbers, heading: Heading::at(heading, direction) }
    }

    /// The spin that is expected.
    #[inline(always)]
    pub(crate) fn expected(&self) -> f64 {
        self.numbers[2]
    }

    /// Sine and cosine of its half turn.
    #[inline(always)]
    pub(crate) fn half_turn(&self) -> (f64, f64) {
        (self.numbers[0], self.numbers[1])
    }

    /// Leaves to the next step what one of length `h` with the spin `w` does.
    ///
    /// A spin is expected two steps after the last one that it is expected from, so that the sine and cosine of its half turn are
    /// there before the step between has ended.
    #[inline(always)]
    pub(crate) fn leave(&mut self, h: f64, w: f64) {
        let [sin, cos, expected, following, differences @ ..] = &mut *self.numbers;
        *expected = *following;
        (*sin, *cos) = series(0.5 * h * *expected);
        [*following] = after_next([w], differences);
    }
}

// A call, since few steps come here, into memory, where what was remembered is read from.
#[cold]
#[inline(never)]
fn begin(memory: &mut Memory, h: f64, w: f64) {
    memory.begin(h, KIND);
    let (heading, numbers) = memory.parts::<_, SIZE>();
    let [none, zero] = [f64::NAN, 0.0];
    (*numbers, *heading) = ([none, none, none, w, w, zero, zero, zero, zero, zero], NO_HEADING);
}
