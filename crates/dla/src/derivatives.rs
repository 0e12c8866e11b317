use lagrangian::linear::{Inverse, Singular};
use std::array::from_fn;

/// Systems of more coordinates or constraints are not remembered.
pub(crate) const COORDINATES: usize = 8;

pub(crate) type Row = [f64; COORDINATES];

/// The inverse of a matrix of derivatives, by columns, which serves several steps.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub(crate) struct Derivatives {
    columns: [Row; COORDINATES],
    /// Whether its determinant is positive.
    pub(crate) positive: bool,
    /// Whether it is time for new ones.
    pub(crate) stale: bool,
    /// The corrections that the first search with them took, and how many more all took after it.
    least: u32,
    more: u32,
    /// How many they were.
    searches: u32,
    /// For how many searches each is to have its own.
    own: u32,
}

impl Derivatives {
    pub(crate) const NONE: Self = Self {
        columns: [[0.0; COORDINATES]; COORDINATES],
        positive: true,
        stale: true,
        least: 0,
        more: 0,
        searches: 0,
        own: 0,
    };

    /// New ones, given by rows.
    ///
    /// # Errors
    /// [`Singular`] where they have no inverse.
    #[inline(never)]
    pub(crate) fn renew<const N: usize>(&mut self, matrix: &[[f64; N]; N]) -> Result<(), Singular> {
        let inverse = Inverse::new(matrix)?;
        for (j, column) in self.columns.iter_mut().take(N).enumerate() {
            let unit = from_fn(|i| f64::from(u8::from(i == j)));
            column[..N].copy_from_slice(&inverse.solve(&unit));
        }
        self.positive = inverse.is_positive();
        (self.stale, self.more, self.searches) = (false, 0, 0);
        Ok(())
    }

    /// As if there had been none.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        (self.stale, self.own) = (true, 0);
    }

    /// The product of the inverse with a vector.
    #[inline(always)]
    pub(crate) fn times<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        if N <= 4 { self.times_of::<N, N>(x) } else { self.times_of::<N, COORDINATES>(x) }
    }

    /// The same by columns of `W` places: beyond four whole registers are quicker.
    #[inline(always)]
    fn times_of<const N: usize, const W: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let mut sum = [0.0; W];
        for (column, x) in self.columns.iter().zip(x) {
            for i in 0..W {
                sum[i] += column[i] * x;
            }
        }
        from_fn(|i| sum[i])
    }

    /// That a search with them took so many corrections. They are to be renewed where they have cost more than that.
    #[inline(always)]
    pub(crate) fn took<const N: usize>(&mut self, corrections: u32) {
        /// So many searches in a row have their own where a second one is not worth it.
        const OWN: u32 = 16;
        // About as many corrections take the time of new derivatives.
        let price = const { (N * N * N).div_ceil(27) as u32 };
        self.searches = self.searches.saturating_add(1);
        if self.searches == 1 {
            self.least = corrections;
            self.stale = self.own > 0;
            self.own = self.own.saturating_sub(1);
            return;
        }
        self.more = self.more.saturating_add(corrections.saturating_sub(self.least));
        self.stale = self.more >= price;
        if self.stale && self.searches == 2 {
            self.own = OWN;
        }
    }

    /// Every number of it, in a fixed order.
    pub(crate) fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let Self { columns, positive, stale, least, more, searches, own } = self;
        columns.as_flattened_mut().iter_mut().for_each(&mut visit);
        for flag in [positive, stale] {
            switch(flag, &mut visit);
        }
        for count in [least, more, searches, own] {
            counted(count, &mut visit);
        }
    }
}

/// A count as a number, there and back.
pub(crate) fn counted(count: &mut u32, visit: &mut impl FnMut(&mut f64)) {
    let mut number = f64::from(*count);
    visit(&mut number);
    // What is no count becomes one.
    *count = number as u32;
}

/// A flag as a number, there and back.
pub(crate) fn switch(flag: &mut bool, visit: &mut impl FnMut(&mut f64)) {
    let mut number = f64::from(u8::from(*flag));
    visit(&mut number);
    *flag = number != 0.0;
}
