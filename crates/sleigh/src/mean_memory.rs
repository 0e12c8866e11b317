use crate::differences::after_next;
use crate::half_turn::{half_turn, series};
use crate::heading::Heading;
use lagrangian::Memory;
use std::hint::cold_path;

/// As many differences of the mean velocities are kept, with the last ones themselves.
const KEPT: usize = 8;
/// Tells these numbers, in this order, from those of other maps and orders: a checkpoint may be older.
const KIND: f64 = 4.0;

/// What a step of the pushed map leaves to the next.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeanMemory {
    /// The mean velocities expected there, with the sine and cosine of the half turn.
    pub(crate) expected: [f64; 2],
    pub(crate) half_turn: [f64; 2],
    /// The mean velocities expected one step later.
    following: [f64; 2],
    /// The last ones and their first backward differences.
    differences: [[f64; 2]; KEPT],
    pub(crate) heading: Heading,
}

impl MeanMemory {
    /// What steps of length `h` have left to one that begins at this heading with the velocities `x`; before a first one, as after
    /// many that had these. None where the blade would then turn by a right angle in half the step.
    #[inline(always)]
    pub(crate) fn of(memory: &Memory, h: f64, heading: f64, x: [f64; 2]) -> Option<Self> {
        let mut differences = [[0.0; 2]; KEPT];
        if !memory.is_of(h, KIND) {
            cold_path();
            differences[0] = x;
            let half_turn = half_turn(0.5 * h * x[1]).ok()?.into();
            return Some(Self { expected: x, half_turn, following: x, differences, heading: Heading::of(heading) });
        }
        let &[_, _, u, w, sin, cos, u2, w2, angle, sin0, cos0, slack, ref kept @ ..] = &memory.0;
        for j in 0..KEPT {
            differences[j] = [kept[2 * j], kept[2 * j + 1]];
        }
        let heading = Heading::remembered(&[angle, sin0, cos0, slack], heading);
        Some(Self { expected: [u, w], half_turn: [sin, cos], following: [u2, w2], differences, heading })
    }

    /// Leaves to the next step what one of length `h` with the mean velocities `x` does, that has turned the heading to this sine and
    /// cosine.
    ///
    /// The mean velocities are expected two steps after the last ones that they are expected from, so that nothing of them
    /// waits for the step between.
    #[inline(always)]
    pub(crate) fn leave(&self, memory: &mut Memory, h: f64, x: [f64; 2], ended: [f64; 2]) {
        let ([u, w], (sin, cos)) = (self.following, series(0.5 * h * self.following[1]));
        let ([u2, w2], differences) = after_next(x, self.differences);
        let [angle, sin0, cos0, slack] = self.heading.turned(h * x[1], ended);
        let mut numbers = [0.0; 10 + 2 * KEPT];
        numbers[..10].copy_from_slice(&[u, w, sin, cos, u2, w2, angle, sin0, cos0, slack]);
        numbers[10..].copy_from_slice(differences.as_flattened());
        memory.keep(h, KIND, numbers);
    }
}
