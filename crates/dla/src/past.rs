use crate::{Checkpoint, CheckpointError};
use std::array::from_fn;

/// As many give an extrapolation of order 5 in the step.
const USED: usize = 5;
/// Places, of which the place of a step is found without a division.
const PLACES: usize = 8;

/// The increments of the last steps, all of one length, from which the next one is extrapolated: a search that begins there
/// is short, and what begins it need not wait for the end of the step before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Past<const N: usize> {
    step: f64,
    made: usize,
    /// Where the next one goes; those before it stand backward from there, around the end.
    place: usize,
    /// Of every coordinate.
    increments: [[f64; PLACES]; N],
}

impl<const N: usize> PartialEq for Past<N> {
    /// What has been forgotten is no part of it.
    fn eq(&self, other: &Self) -> bool {
        let same_step = self.made == 0 || self.step.to_bits() == other.step.to_bits();
        self.made == other.made && same_step && (1..=self.made).all(|i| self.back(i) == other.back(i))
    }
}

impl<const N: usize> Past<N> {
    /// No step yet.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self { step: 0.0, made: 0, place: 0, increments: [[0.0; PLACES]; N] }
    }

    /// Adds the increment of a step of length `h`; what was before steps of another length is forgotten.
    // None is moved: numbers that were just written one by one would be read again by several, for which a processor waits.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only steps of the very same length are points of one sequence")]
    pub(crate) fn push(&mut self, h: f64, increment: &[f64; N]) {
        if self.step != h {
            (self.step, self.made) = (h, 0);
        }
        self.made = USED.min(self.made + 1);
        for i in 0..N {
            self.increments[i][self.place % PLACES] = increment[i];
        }
        self.place = (self.place + 1) % PLACES;
    }

    /// The increment `i` steps before the next one.
    #[inline(always)]
    fn back(&self, i: usize) -> [f64; N] {
        let place = self.place.wrapping_sub(i) % PLACES;
        from_fn(|k| self.increments[k][place])
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
        if self.made < USED || self.step != h {
            return None;
        }
        let [a, b, c, d, e] = from_fn(|i| self.back(i + 1));
        // The last one is used last, since it is known last.
        Some(from_fn(|i| 5.0 * a[i] + (10.0 * (c[i] - b[i]) + (e[i] - 5.0 * d[i]))))
    }

    /// Every number of it, in a fixed order.
    pub(crate) fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let (mut made, mut place) = (self.made as f64, self.place as f64);
        visit(&mut made);
        visit(&mut place);
        // What is no number of steps becomes one.
        (self.made, self.place) = (USED.min(made as usize), place as usize % PLACES);
        visit(&mut self.step);
        self.increments.as_flattened_mut().iter_mut().for_each(visit);
    }

    /// Writes every bit to a checkpoint, the last increment first.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        let steps = if self.made == 0 { vec![] } else { vec![self.step] };
        let of_steps: Vec<f64> = (1..=self.made).flat_map(|i| self.back(i)).collect();
        checkpoint.put("past", &[steps, of_steps].concat());
    }

    /// What [`save`](Self::save) wrote.
    pub(crate) fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let mut past = Self::new();
        if let Some((step, increments)) = checkpoint.list("past")?.split_first() {
            for increment in increments.rchunks_exact(N.max(1)) {
                past.push(*step, &from_fn(|i| increment[i]));
            }
        }
        Ok(past)
    }
}
