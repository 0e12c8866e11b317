use crate::{Checkpoint, CheckpointError};
use std::array::from_fn;

/// As many give an extrapolation of order 5 in the step.
const KEPT: usize = 5;

/// The increments of the last steps, all of one length, from which the next one is extrapolated: a search that begins there
/// is short, and what begins it need not wait for the end of the step before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Past<const N: usize> {
    step: f64,
    made: usize,
    /// The last first.
    increments: [[f64; N]; KEPT],
}

impl<const N: usize> PartialEq for Past<N> {
    /// What has been forgotten is no part of it.
    fn eq(&self, other: &Self) -> bool {
        let same_step = self.made == 0 || self.step.to_bits() == other.step.to_bits();
        self.made == other.made && same_step && self.increments[..self.made] == other.increments[..self.made]
    }
}

impl<const N: usize> Past<N> {
    /// No step yet.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self { step: 0.0, made: 0, increments: [[0.0; N]; KEPT] }
    }

    /// Adds the increment of a step of length `h`; what was before steps of another length is forgotten.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn push(&mut self, h: f64, increment: &[f64; N]) {
        self.made = if self.step == h { KEPT.min(self.made + 1) } else { 1 };
        self.step = h;
        self.increments.copy_within(..KEPT - 1, 1);
        self.increments[0] = *increment;
    }

    /// No step yet, again.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        self.made = 0;
    }

    /// The increment of one more step of length `h`: their fifth difference would vanish.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn next(&self, h: f64) -> Option<[f64; N]> {
        let [a, b, c, d, e] = &self.increments;
        // The last one is used last, since it is known last.
        (self.made == KEPT && self.step == h)
            .then(|| from_fn(|i| 5.0 * a[i] + (10.0 * (c[i] - b[i]) + (e[i] - 5.0 * d[i]))))
    }

    /// Every number of it, in a fixed order.
    pub(crate) fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let mut made = self.made as f64;
        visit(&mut made);
        // What is no number of steps becomes one.
        self.made = KEPT.min(made as usize);
        visit(&mut self.step);
        self.increments.as_flattened_mut().iter_mut().for_each(visit);
    }

    /// Writes every bit to a checkpoint.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        let steps = if self.made == 0 { vec![] } else { vec![self.step] };
        let of_steps = self.increments[..self.made].as_flattened();
        checkpoint.put("past", &[steps.as_slice(), of_steps].concat());
    }

    /// What [`save`](Self::save) wrote.
    pub(crate) fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let mut past = Self::new();
        if let Some((step, increments)) = checkpoint.list("past")?.split_first() {
            past.step = *step;
            for (place, increment) in past.increments.iter_mut().zip(increments.chunks_exact(N.max(1))) {
                place.copy_from_slice(increment);
                past.made += 1;
            }
        }
        Ok(past)
    }
}
