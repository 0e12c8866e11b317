use crate::differences::after_next;
use crate::half_turn::{half_turn, series};
use crate::heading::{Heading, NO_HEADING};
use lagrangian::Memory;

/// As many differences of the mean velocities are kept, with the last ones themselves.
const KEPT: usize = 8;
/// Numbers before them.
const EXPECTED: usize = 6;
const SIZE: usize = EXPECTED + 2 * KEPT;
/// Tells these numbers, in this order, from those of other maps and orders: a checkpoint may be older.
const KIND: f64 = 6.0;

/// What a step of the pushed map leaves to the next, which changes it in place.
#[derive(Debug)]
pub(crate) struct MeanMemory<'a> {
    /// Sine and cosine of the half turn of the mean velocities that are expected here, these, and those expected one step later; then
    /// the last ones and their first backward differences. They are read where they are used, so that until then they need no other
    /// place.
    numbers: &'a mut [f64; SIZE],
    pub(crate) heading: Heading<'a>,
}

impl<'a> MeanMemory<'a> {
    /// What steps of length `h` have left to one that begins at this heading with the velocities `x`; before a first one, as after
    /// many that had these. None where the blade would then turn by a right angle in half the step.
    #[inline(always)]
    pub(crate) fn of(memory: &'a mut Memory, h: f64, heading: f64, x: [f64; 2]) -> Option<Self> {
        if !memory.is_of(h, KIND) {
            begin(memory, h, x)?;
        }
        // The heading first: behind the differences, its sine would be stored with them, and its cosine be waited for, which is read with it.
        let (direction, numbers) = memory.parts();
        Some(Self { numbers, heading: Heading::at(heading, direction) })
    }

    /// The mean velocities that are expected.
    #[inline(always)]
    pub(crate) fn expected(&self) -> [f64; 2] {
        [self.numbers[2], self.numbers[3]]
    }

    /// Sine and cosine of the half turn.
    #[inline(always)]
    pub(crate) fn half_turn(&self) -> [f64; 2] {
        [self.numbers[0], self.numbers[1]]
    }

    /// Leaves to the next step what one of length `h` with the mean velocities `x` does.
    ///
    /// The mean velocities are expected two steps after the last ones that they are expected from, so that nothing of them
    /// waits for the step between.
    #[inline(always)]
    pub(crate) fn leave(&mut self, h: f64, x: [f64; 2]) {
        let [sin, cos, u, w, u2, w2, differences @ ..] = &mut *self.numbers;
        (*u, *w) = (*u2, *w2);
        (*sin, *cos) = series(0.5 * h * *w);
        [*u2, *w2] = after_next(x, differences);
    }
}

// A call, since few steps come here, into memory, where what was remembered is read from.
#[cold]
#[inline(never)]
fn begin(memory: &mut Memory, h: f64, x: [f64; 2]) -> Option<()> {
    let (sin, cos) = half_turn(0.5 * h * x[1]).ok()?;
    memory.begin(h, KIND);
    let (heading, numbers) = memory.parts::<_, SIZE>();
    (*numbers, *heading) = ([0.0; SIZE], NO_HEADING);
    numbers[..EXPECTED + 2].copy_from_slice(&[sin, cos, x[0], x[1], x[0], x[1], x[0], x[1]]);
    Some(())
}
