use crate::{Checkpoint, CheckpointError};
use lagrangian::mul_add;
use std::fmt;

/// As many steps give an extrapolation of order 7 in the step.
const USUAL: usize = 7;
/// Fewer say less than the last acceleration.
const FEWEST: usize = 3;

/// The increments of the last steps, all of one length, from which the next one is extrapolated: a search that begins there
/// is short, and what begins it need not wait for the end of the step before.
#[derive(Clone, Copy)]
pub(crate) struct Past<const N: usize, const K: usize = USUAL> {
    /// The increment of one more step.
    next: [f64; N],
    /// Each stands here twice, `K` places apart, so that the last ones stand together wherever the last is, and none is ever
    /// moved.
    increments: [[[f64; N]; K]; 2],
    step: f64,
    made: usize,
    /// Where the last one stands; those before it follow.
    last: usize,
}

impl<const N: usize, const K: usize> fmt::Debug for Past<N, K> {
    /// Not where they happen to stand.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Past").field("step", &self.step).field("increments", &self.increments()).finish()
    }
}

impl<const N: usize, const K: usize> PartialEq for Past<N, K> {
    /// What has been forgotten is no part of it.
    fn eq(&self, other: &Self) -> bool {
        let same_step = self.made == 0 || self.step.to_bits() == other.step.to_bits();
        self.made == other.made && same_step && self.increments() == other.increments()
    }
}

impl<const N: usize, const K: usize> Past<N, K> {
    /// Of one more than the index, binomial coefficients: with them the next difference vanishes.
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

    /// Finds the increment of one more step after the last one. That is done here, and not where it is asked for, since what has
    /// just been stored would be waited for there.
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

    /// Whether as many are remembered as are of use.
    #[inline(always)]
    pub(crate) fn is_full(&self) -> bool {
        self.made >= K
    }

    /// No step yet, again.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        self.made = 0;
    }

    /// That of the last step; zero of no step.
    #[inline(always)]
    pub(crate) fn last(&self) -> [f64; N] {
        self.increments[0].get(self.last).copied().unwrap_or([0.0; N])
    }

    /// The last first, with what stands after those that there are.
    #[inline(always)]
    fn rows(&self) -> Option<&[[f64; N]; K]> {
        self.increments.as_flattened().get(self.last..)?.first_chunk()
    }

    /// The last first.
    fn increments(&self) -> &[[f64; N]] {
        self.rows().map_or(&[], |rows| &rows[..self.made])
    }

    /// The increment of one more step of length `h`, with which the next difference of those that are there would vanish.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn next(&self, h: f64) -> Option<[f64; N]> {
        (self.step == h && self.made >= FEWEST).then_some(self.next)
    }

    /// The same from however few there are.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn following(&self, h: f64) -> Option<[f64; N]> {
        (self.step == h && self.made > 0).then_some(self.next)
    }

    /// Every number of it, in a fixed order.
    pub(crate) fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let mut made = self.made as f64;
        visit(&mut made);
        // What is no number of steps becomes one.
        self.made = K.min(made as usize);
        visit(&mut self.step);
        // The last first, wherever they stand.
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

    /// What [`save`](Self::save) wrote.
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
