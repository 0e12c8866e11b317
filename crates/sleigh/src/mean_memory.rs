use crate::differences::after_next;
use crate::half_turn::{BROAD, half_turn, series};
use lagrangian::Memory;

/// As many differences of the mean velocities are kept, with the last ones themselves.
const KEPT: usize = 8;
/// Tells these numbers from those of other maps.
const KIND: f64 = 2.0;

/// What a step of the pushed map leaves to the next.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeanMemory {
    /// The mean velocities expected there, with the sine and cosine of the half turn.
    pub(crate) expected: [f64; 2],
    pub(crate) half_turn: [f64; 2],
    /// Sine and cosine of the heading where it begins.
    pub(crate) heading: [f64; 2],
    /// The mean velocities expected one step later.
    following: [f64; 2],
    /// The last ones and their first backward differences.
    differences: [[f64; 2]; KEPT],
}

impl MeanMemory {
    /// Before a first step of length `h` that begins with the velocities `x`: as after many that had these. None where the
    /// blade would turn by a right angle in half the step.
    #[inline(always)]
    pub(crate) fn fresh(h: f64, x: [f64; 2], heading: [f64; 2]) -> Option<Self> {
        let mut differences = [[0.0; 2]; KEPT];
        differences[0] = x;
        let half_turn = half_turn(0.5 * h * x[1]).ok()?.into();
        Some(Self { expected: x, half_turn, heading, following: x, differences })
    }

    /// What steps of length `h` have left, if anything.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn of(memory: &Memory, h: f64) -> Option<Self> {
        let &[of, kind, u, w, sin, cos, sin0, cos0, u2, w2, ref differences @ ..] = &memory.0;
        (of == h && kind == KIND).then(|| {
            let mut pairs = [[0.0; 2]; KEPT];
            for j in 0..KEPT {
                pairs[j] = [differences[2 * j], differences[2 * j + 1]];
            }
            Self {
                expected: [u, w],
                half_turn: [sin, cos],
                heading: [sin0, cos0],
                following: [u2, w2],
                differences: pairs,
            }
        })
    }

    /// What a step of length `h` with the mean velocities `x` leaves, whose heading has ended at this sine and cosine.
    ///
    /// The mean velocities are expected two steps after the last ones that they are expected from, so that nothing of them
    /// waits for the step between. They are not numbers where the turn is too large for a series.
    #[inline(always)]
    pub(crate) fn after(&self, h: f64, x: [f64; 2], [sin0, cos0]: [f64; 2]) -> Memory {
        let d = 0.5 * h * self.following[1];
        let (sin, cos) = series(d);
        let [u, w] = if d.abs() <= BROAD { self.following } else { [f64::NAN; 2] };
        let ([u2, w2], differences) = after_next(x, self.differences);
        let mut memory = Memory([0.0; Memory::SIZE]);
        memory.0[..10].copy_from_slice(&[h, KIND, u, w, sin, cos, sin0, cos0, u2, w2]);
        memory.0[10..].copy_from_slice(differences.as_flattened());
        memory
    }
}
