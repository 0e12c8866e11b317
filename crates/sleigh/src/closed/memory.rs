use super::half_turn::series;
use super::heading::Heading;
use lagrangian::{from_fn, mul_add};

/// Numbers that a step in closed form leaves to the next one, from which the search there is short.
///
/// They begin with the length of the step, which is zero where there is nothing to remember, and a number that tells whose they are;
/// the others are the map's own affair.
#[derive(Debug, Clone, Copy)]
pub struct Memory(pub [f64; Self::SIZE]);

impl Memory {
    /// As many numbers as the map with forces leaves; the free one leaves fewer.
    pub const SIZE: usize = 30;
    /// Nothing yet.
    pub const EMPTY: Self = Self([0.0; Self::SIZE]);

    /// Is of steps of this length from now on, and of this kind.
    #[inline(always)]
    pub fn begin(&mut self, h: f64, kind: f64) {
        (self.0[0], self.0[1]) = (h, kind);
    }

    /// Its first numbers and those after them, to be read where they are used and changed in place.
    ///
    /// Does not compile for more than there is place for.
    #[inline(always)]
    pub fn parts<const A: usize, const B: usize>(&mut self) -> (&mut [f64; A], &mut [f64; B]) {
        const { assert!(A + B + 2 <= Self::SIZE) };
        let [_, _, numbers @ ..] = &mut self.0;
        if let Some((first, others)) = numbers.split_first_chunk_mut()
            && let Some(second) = others.first_chunk_mut()
        {
            return (first, second);
        }
        unreachable!("there is place for them")
    }

    /// Whether a step of this very length has left numbers of this kind.
    #[must_use]
    #[inline(always)]
    pub fn is_of(&self, h: f64, kind: f64) -> bool {
        // As bits, for one branch.
        (self.0[0].to_bits() ^ h.to_bits()) | (self.0[1].to_bits() ^ kind.to_bits()) == 0
    }

    /// Whether there is nothing.
    #[must_use]
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.0[0] == 0.0
    }

    /// Nothing, again.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.0[0] = 0.0;
    }
}

impl Default for Memory {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl PartialEq for Memory {
    /// Nothing is all the same.
    fn eq(&self, other: &Self) -> bool {
        (self.is_empty() && other.is_empty()) || self.0.map(f64::to_bits) == other.0.map(f64::to_bits)
    }
}

/// The numbers that a step leaves to the next, which changes them in place. The map has `P` unknowns, the last of which is the mean spin.
#[derive(Debug)]
pub(crate) struct Foreseen<'a, const P: usize, const KEPT: usize, const N: usize> {
    /// In this order: sine and cosine of the expected half turn, the unknowns expected in this step, the unknowns expected one step
    /// later, `KEPT` rows of the last unknowns and their backward differences, and numbers of the map's own. They are read in place.
    pub(crate) numbers: &'a mut [f64; N],
    pub(crate) heading: Heading<'a>,
}

impl<'a, const P: usize, const KEPT: usize, const N: usize> Foreseen<'a, P, KEPT, N> {
    /// The numbers left by the step before, for a step that begins at this heading.
    #[inline(always)]
    pub(crate) fn of(memory: &'a mut Memory, heading: f64) -> Self {
        // The heading first: behind the differences, its sine would be stored with them, and its cosine be waited for, which is read
        // with it.
        let (direction, numbers) = memory.parts();
        Self { numbers, heading: Heading::at(heading, direction) }
    }

    /// The expected unknowns.
    #[inline(always)]
    pub(crate) fn expected(&self) -> [f64; P] {
        from_fn(|i| self.numbers[2 + i])
    }

    /// Sine and cosine of the expected half turn.
    #[inline(always)]
    pub(crate) fn half_turn(&self) -> [f64; 2] {
        [self.numbers[0], self.numbers[1]]
    }

    /// Stores the numbers for the next step, after a step of length `h` with the unknowns `x`.
    ///
    /// The unknowns are extrapolated by two steps, so that sine and cosine of their half turn are computed while the step between is
    /// still running.
    #[inline(always)]
    pub(crate) fn leave(&mut self, h: f64, x: [f64; P]) {
        let (expected, differences) = self.numbers[..2 + (2 + KEPT) * P].split_at_mut(2 + 2 * P);
        for i in 0..P {
            expected[2 + i] = expected[2 + P + i];
        }
        (expected[0], expected[1]) = series(0.5 * h * expected[1 + P]);
        expected[2 + P..].copy_from_slice(&after_next(x, differences));
    }
}

/// Extrapolates `P` sequences by two steps, as if their `K`th backward differences vanished. `differences` has one row of `P` for each
/// order from 0 on; it changes from the differences before `x` to the differences at `x`.
///
/// The result is `x + 2 e_1 + .. + K e_(K-1)` with the new differences `e_j = e_(j-1) - before_(j-1)`. All of it but a multiple of `x`
/// is known beforehand, so only one product waits for `x`.
#[inline(always)]
fn after_next<const P: usize>(x: [f64; P], differences: &mut [f64]) -> [f64; P] {
    let rows = differences.len() / P;
    let all = (rows * (rows + 1) / 2) as f64;
    let mut left = all - 1.0;
    let (mut known, mut new): ([f64; P], _) = (from_fn(|i| left * differences[i]), x);
    for j in 1..rows {
        left -= (j + 1) as f64;
        for i in 0..P {
            let before = &mut differences[P * (j - 1) + i];
            (*before, new[i]) = (new[i], new[i] - *before);
            if j < rows - 1 {
                known[i] = mul_add(left, differences[P * j + i], known[i]);
            }
        }
    }
    for i in 0..P {
        differences[P * (rows - 1) + i] = new[i];
    }
    from_fn(|i| mul_add(all, x[i], -known[i]))
}
