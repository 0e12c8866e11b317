use crate::differences::after_next;
use crate::half_turn::series;
use crate::heading::Heading;
use lagrangian::Memory;
use std::hint::cold_path;

/// As many differences of the spins are kept, with the last one itself.
const KEPT: usize = 6;
/// Tells these numbers, in this order, from those of other maps and orders: a checkpoint may be older.
const KIND: f64 = 3.0;

/// What a step of the closed map leaves to the next: the spin expected there, with the sine and cosine of its half turn, the spin
/// expected one step later, those of the last steps, and the heading.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpinMemory {
    pub(crate) expected: f64,
    pub(crate) half_turn: (f64, f64),
    following: f64,
    /// The last spin and its first backward differences.
    differences: [f64; KEPT],
    pub(crate) heading: Heading,
}

impl SpinMemory {
    /// What steps of length `h` have left to one that begins at this heading; before a first one nothing, as after many of the spin
    /// `w`.
    #[inline(always)]
    pub(crate) fn of(memory: &Memory, h: f64, (heading, w): (f64, f64)) -> Self {
        let [_, _, sin, cos, expected, following, e0, e1, e2, e3, e4, e5, angle, sin0, cos0, slack, ..] = memory.0;
        if memory.is_of(h, KIND) {
            let heading = Heading::remembered(&[angle, sin0, cos0, slack], heading);
            return Self { expected, half_turn: (sin, cos), following, differences: [e0, e1, e2, e3, e4, e5], heading };
        }
        cold_path();
        let (heading, differences) = (Heading::of(heading), [w, 0.0, 0.0, 0.0, 0.0, 0.0]);
        Self { expected: f64::NAN, half_turn: (f64::NAN, f64::NAN), following: w, differences, heading }
    }

    /// Leaves to the next step what one of length `h` with the spin `w` does, that has turned the heading to this sine and cosine.
    ///
    /// A spin is expected two steps after the last one that it is expected from, so that the sine and cosine of its half turn are
    /// there before the step between has ended.
    #[inline(always)]
    pub(crate) fn leave(&self, memory: &mut Memory, h: f64, w: f64, ended: [f64; 2]) {
        let (sin, cos) = series(0.5 * h * self.following);
        let ([following], [[e0], [e1], [e2], [e3], [e4], [e5]]) = after_next([w], self.differences.map(|e| [e]));
        let [angle, sin0, cos0, slack] = self.heading.turned(h * w, ended);
        let numbers = [sin, cos, self.following, following, e0, e1, e2, e3, e4, e5, angle, sin0, cos0, slack];
        memory.keep(h, KIND, numbers);
    }
}
