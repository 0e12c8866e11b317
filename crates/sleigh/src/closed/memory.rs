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
