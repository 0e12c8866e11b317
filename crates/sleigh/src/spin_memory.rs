use crate::half_turn::{BROAD, series};
use lagrangian::{Memory, mul_add};

/// What a step of the closed map leaves to the next: the spin expected there, with the sine and cosine of its half turn, the spin
/// expected one step later, and those of the last steps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpinMemory {
    pub(crate) expected: f64,
    pub(crate) half_turn: (f64, f64),
    following: f64,
    /// The last spin and its first five backward differences.
    differences: [f64; 6],
}

impl SpinMemory {
    /// What steps of length `h` have left; before a first one nothing, as after many of the spin `w`.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn of(memory: &Memory, h: f64, w: f64) -> Self {
        let [of, expected, sin, cos, following, differences @ ..] = memory.0;
        if of == h {
            return Self { expected, half_turn: (sin, cos), following, differences };
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
    /// A spin is expected two steps after the last one that it is expected from, where their seventh difference vanishes: the
    /// sine and cosine of its half turn then are there before the step between has ended. It is not a number where the
    /// turn is too large for a series.
    #[inline(always)]
    pub(crate) fn after(&self, h: f64, w: f64) -> Memory {
        let &Self { following, differences: [x, d1, d2, d3, d4, d5], .. } = self;
        let d = 0.5 * h * following;
        let (sin, cos) = series(d);
        let expected = if d.abs() <= BROAD { following } else { f64::NAN };

        // w + 2 e1 + .. + 7 e6 with the new differences, of which but w is known: that is all that waits for w.
        let known = mul_add(7.0, d5, mul_add(13.0, d4, mul_add(18.0, d3, 22.0 * d2))) + mul_add(25.0, d1, 27.0 * x);
        let following = mul_add(28.0, w, -known);
        let e1 = w - x;
        let e2 = e1 - d1;
        let e3 = e2 - d2;
        let e4 = e3 - d3;
        let e5 = e4 - d4;
        Memory([h, expected, sin, cos, following, w, e1, e2, e3, e4, e5])
    }
}
