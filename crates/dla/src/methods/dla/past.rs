use crate::{Checkpoint, CheckpointError};
use lagrangian::mul_add;
use std::fmt;

/// Number of steps that give a predictor of order 7 in the step.
const K: usize = 7;
/// From fewer the predictor is worse than that from the last acceleration.
const FEWEST: usize = 3;

/// A predictor: the increments of the last steps, all of one length, and the next one extrapolated from them by backward differences.
///
/// An iteration that starts there is short. The prediction is made when an increment is stored, so that the next step does not load what
/// has just been stored.
#[derive(Clone, Copy)]
pub(crate) struct Past<const N: usize> {
    /// The increment of one more step.
    next: [f64; N],
    /// A ring buffer that holds each increment twice, `K` places apart: so the last `K` are contiguous wherever the last one is, and
    /// none is ever moved.
    increments: [[[f64; N]; K]; 2],
    step: f64,
    made: usize,
    /// The index of the last one; earlier ones follow it.
    last: usize,
}

impl<const N: usize> fmt::Debug for Past<N> {
    /// Without the positions in the buffer.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Past").field("step", &self.step).field("increments", &self.increments()).finish()
    }
}

impl<const N: usize> PartialEq for Past<N> {
    /// Forgotten increments do not count.
    fn eq(&self, other: &Self) -> bool {
        let same_step = self.made == 0 || self.step.to_bits() == other.step.to_bits();
        self.made == other.made && same_step && self.increments() == other.increments()
    }
}

impl<const N: usize> Past<N> {
    /// Binomial coefficients, for one increment more than the index: with them the next backward difference vanishes.
    const WEIGHTS: [[f64; K]; K] = {
        let mut all = [[0.0; K]; K];
        let mut made = 1;
        while made <= K {
            // (-1)^j C(made, j + 1)
            let (mut j, mut weight) = (0, made as f64);
            while j < made {
                all[made - 1][j] = weight;
                weight = -weight * (made - 1 - j) as f64 / (j + 2) as f64;
                j += 1;
            }
            made += 1;
        }
        all
    };

    /// No step yet.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self { step: 0.0, made: 0, last: 0, increments: [[[0.0; N]; K]; 2], next: [0.0; N] }
    }

    /// Adds the increment of a step of length `h`; what was before steps of another length is forgotten.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn push(&mut self, h: f64, increment: &[f64; N]) {
        self.made = if self.step == h { K.min(self.made + 1) } else { 1 };
        self.step = h;
        self.last = if self.last == 0 { K - 1 } else { self.last - 1 };
        for copy in &mut self.increments {
            copy[self.last] = *increment;
        }
        self.extrapolate(increment);
    }

    /// Computes the prediction for one more step, from the last increment in registers. Where the prediction is asked for, the increments
    /// would be loaded in another width than they were stored in, and loads cannot be forwarded from such stores.
    #[inline(always)]
    fn extrapolate(&mut self, last: &[f64; N]) {
        let Some((weights, rows)) = Self::WEIGHTS.get(self.made.wrapping_sub(1)).zip(self.rows()) else { return };
        let mut sum = [0.0; N];
        for j in (1..K).rev() {
            for i in 0..N {
                sum[i] = mul_add(weights[j], rows[j][i], sum[i]);
            }
        }
        for i in 0..N {
            self.next[i] = mul_add(weights[0], last[i], sum[i]);
        }
    }

    /// Forgets all increments.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        self.made = 0;
    }

    /// The increment of the last step; zero before the first.
    #[inline(always)]
    pub(crate) fn last(&self) -> [f64; N] {
        self.increments[0].get(self.last).copied().unwrap_or([0.0; N])
    }

    /// All `K` places, the last increment first; beyond those that were made, anything.
    #[inline(always)]
    fn rows(&self) -> Option<&[[f64; N]; K]> {
        self.increments.as_flattened().get(self.last..)?.first_chunk()
    }

    /// The increments, the last one first.
    fn increments(&self) -> &[[f64; N]] {
        self.rows().map_or(&[], |rows| &rows[..self.made])
    }

    /// The prediction for one more step of length `h`; `None` from fewer than three steps of that length.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn next(&self, h: f64) -> Option<[f64; N]> {
        (self.step == h && self.made >= FEWEST).then_some(self.next)
    }

    /// Every number of it, in a fixed order.
    pub(crate) fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let mut made = self.made as f64;
        visit(&mut made);
        // A number from a file that is no count saturates to one.
        self.made = K.min(made as usize);
        visit(&mut self.step);
        // The last first, wherever it is in the buffer.
        let mut increments = self.rows().copied().unwrap_or([[0.0; N]; K]);
        increments.as_flattened_mut().iter_mut().for_each(visit);
        (self.last, self.increments) = (0, [increments; 2]);
        self.extrapolate(&self.last());
    }

    /// Writes every bit to a checkpoint.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        let steps = if self.made == 0 { vec![] } else { vec![self.step] };
        let of_steps = self.increments().as_flattened();
        checkpoint.put("past", &[steps.as_slice(), of_steps].concat());
    }

    /// The past that [`save`](Self::save) wrote.
    pub(crate) fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let mut past = Self::new();
        if let Some((step, increments)) = checkpoint.list("past")?.split_first() {
            past.step = *step;
            for increment in increments.chunks_exact(N.max(1)).take(K) {
                for copy in &mut past.increments {
                    copy[past.made].copy_from_slice(increment);
                }
                past.made += 1;
            }
            past.extrapolate(&past.last());
        }
        Ok(past)
    }
}
