use crate::differences::after_next;
use crate::half_turn::{BROAD, series};
use lagrangian::Memory;

/// As many differences of the spins are kept, with the last one itself.
const KEPT: usize = 6;
/// Tells these numbers from those of other maps.
const KIND: f64 = 1.0;

/// What a step of the closed map leaves to the next: the spin expected there, with the sine and cosine of its half turn, the spin
/// expected one step later, and those of the last steps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpinMemory {
    pub(crate) expected: f64,
    pub(crate) half_turn: (f64, f64),
    following: f64,
    /// The last spin and its first backward differences.
    differences: [f64; KEPT],
}

impl SpinMemory {
    /// What steps of length `h` have left; before a first one nothing, as after many of the spin `w`.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn of(memory: &Memory, h: f64, w: f64) -> Self {
        let [of, kind, expected, sin, cos, following, e0, e1, e2, e3, e4, e5, ..] = memory.0;
        if of == h && kind == KIND {
            return Self { expected, half_turn: (sin, cos), following, differences: [e0, e1, e2, e3, e4, e5] };
        }
        let unknown = f64::NAN;
        Self {
            expected: unknown,
            half_turn: (unknown, unknown),
            following: w,
            differences: [w, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// What a step of length `h` with the spin `w` leaves.
    ///
    /// A spin is expected two steps after the last one that it is expected from, so that the sine and cosine of its half turn are
    /// there before the step between has ended. It is not a number where the turn is too large for a series.
    #[inline(always)]
    pub(crate) fn after(&self, h: f64, w: f64) -> Memory {
        let d = 0.5 * h * self.following;
        let (sin, cos) = series(d);
        let expected = if d.abs() <= BROAD { self.following } else { f64::NAN };
        let ([following], [e0, e1, e2, e3, e4, e5]) = after_next([w], self.differences.map(|e| [e]));
        Memory::of([h, KIND, expected, sin, cos, following, e0[0], e1[0], e2[0], e3[0], e4[0], e5[0]])
    }
}
