use lagrangian::linear::{Inverse, larger};
use lagrangian::{from_fn, mul_add};

/// Systems of more coordinates or constraints are not remembered.
pub(crate) const COORDINATES: usize = 8;

/// After so many corrections one is looked at again, and none goes unseen before as many have been made with the same derivatives.
const OFTEN: u32 = 16;
/// A correction is a part of the unknowns that is larger than this where steps before do not foretell it to their rounding: it is looked
/// at.
const SLIGHT: f64 = 1e-12;

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
    /// A part of the unknowns by which a correction with them changed these and was seen to leave rounding, and how many have gone
    /// unseen since.
    seen: f64,
    unseen: u32,
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
        seen: 0.0,
        unseen: 0,
    };

    /// New ones, given by rows; none where they have no inverse, or one that loses digits.
    #[inline(never)]
    pub(crate) fn renew<const N: usize>(&mut self, matrix: &[[f64; N]; N]) -> Option<()> {
        /// More than three digits are left to the general search, which may have a basis to keep them in.
        const CLEAR: f64 = 1e3;
        let inverse = Inverse::new(matrix).ok()?;
        // The diagonal of |K| |K^-1|, whatever the scale of rows and columns. (Skeel 1979, J. ACM 26, 494-526.)
        let mut condition = 0.0;
        for (j, column) in self.columns.iter_mut().take(N).enumerate() {
            let unit = from_fn(|i| f64::from(u8::from(i == j)));
            column[..N].copy_from_slice(&inverse.solve(&unit));
            condition = larger(condition, (0..N).map(|i| (matrix[j][i] * column[i]).abs()).sum());
        }
        self.positive = inverse.is_positive();
        (self.stale, self.more, self.searches, self.seen) = (false, 0, 0, 0.0);
        (condition <= CLEAR).then_some(())
    }

    /// As if there had been none.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        (self.stale, self.own, self.seen) = (true, 0, 0.0);
    }

    /// Whether a correction of the size `d` of unknowns of the size `x` leaves rounding because one as large has been seen to. What a
    /// correction with these derivatives leaves is a part of it that grows with the steps since they were made: not beyond twice
    /// of what was seen before the next one is looked at (as rates of contraction are remembered, Hairer and Wanner 1996, IV.8).
    #[inline(always)]
    pub(crate) fn suffice(&self, d: f64, x: f64) -> bool {
        d <= self.seen * x && self.unseen < OFTEN
    }

    /// That one was believed to.
    #[inline(always)]
    pub(crate) fn go_unseen(&mut self) {
        self.unseen = self.unseen.saturating_add(1);
    }

    /// That a correction of the size `d` of unknowns of the size `x` has left rounding, which is to be `sure`. What was seen longer
    /// ago counts ever less.
    #[inline(always)]
    pub(crate) fn have_sufficed(&mut self, d: f64, x: f64, sure: impl FnOnce() -> bool) {
        if d <= SLIGHT * x && self.searches >= OFTEN && sure() {
            (self.seen, self.unseen) = (larger(d / x, 0.5 * self.seen), 0);
        }
    }

    /// That one has not.
    #[inline(always)]
    pub(crate) fn have_not_sufficed(&mut self) {
        self.seen = 0.0;
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
                // Of few, sums wait for less where products do not wait with them.
                sum[i] = if W > 4 { mul_add(column[i], *x, sum[i]) } else { sum[i] + column[i] * x };
            }
        }
        from_fn(|i| sum[i])
    }

    /// The product of the inverse of a matrix that is the unit matrix beyond the first `D` places with a vector that is zero there.
    #[inline(always)]
    pub(crate) fn times_first<const N: usize>(&self, d: usize, x: &[f64; N]) -> [f64; N] {
        let mut sum = [0.0; N];
        for i in 0..d {
            sum[i] = (1..d).fold(self.columns[0][i] * x[0], |sum, j| sum + self.columns[j][i] * x[j]);
        }
        sum
    }

    /// That a search with them took so many corrections. They are to be renewed where they have cost more than that.
    #[inline(always)]
    pub(crate) fn took<const N: usize>(&mut self, corrections: u32) {
        // About as many corrections take the time of new derivatives.
        let price = const { (N * N * N).div_ceil(27) as u32 };
        self.took_at(price, corrections);
    }

    /// The same in the basis of admissible velocities, where a search takes a correction more now and then without derivatives that are
    /// any older, since the basis itself turns along the way.
    #[inline(always)]
    pub(crate) fn took_in_basis<const N: usize>(&mut self, corrections: u32) {
        let price = const { 8 + (N * N * N).div_ceil(27) as u32 };
        self.took_at(price, corrections);
    }

    #[inline(always)]
    fn took_at(&mut self, price: u32, corrections: u32) {
        /// So many searches in a row have their own where a second one is not worth it.
        const OWN: u32 = 16;
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
        let Self { columns, positive, stale, least, more, searches, own, seen, unseen } = self;
        columns.as_flattened_mut().iter_mut().for_each(&mut visit);
        for flag in [positive, stale] {
            switch(flag, &mut visit);
        }
        visit(seen);
        for count in [least, more, searches, own, unseen] {
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

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn renewed<const N: usize>(matrix: &[[f64; N]; N]) -> Derivatives {
        let mut derivatives = Derivatives::NONE;
        derivatives.renew(matrix).unwrap();
        derivatives
    }

    /// `M^-1 M x = x` below and above the sizes that are inverted by cofactors and padded to registers.
    fn undoes<const N: usize>() {
        let matrix: [[f64; N]; N] =
            from_fn(|i| from_fn(|j| if i == j { 3.0 } else { ((i + 2 * j) as f64).sin() / N as f64 }));
        let x: [f64; N] = from_fn(|i| 1.0 + i as f64);
        let image: [f64; N] = from_fn(|i| (0..N).map(|j| matrix[i][j] * x[j]).sum());
        let derivatives = renewed(&matrix);
        assert!(!derivatives.stale && derivatives.positive);
        let back = derivatives.times(&image);
        for i in 0..N {
            assert_abs_diff_eq!(back[i], x[i], epsilon = 1e-13);
        }
        let mirrored = renewed(&matrix.map(|row| row.map(|x| -x)));
        assert_eq!(mirrored.positive, N.is_multiple_of(2));
    }

    #[test]
    fn the_inverse_undoes_the_matrix() {
        undoes::<1>();
        undoes::<3>();
        undoes::<4>();
        undoes::<7>();
        undoes::<8>();
        let mut none = Derivatives::NONE;
        assert!(none.renew(&[[1.0, 2.0], [2.0, 4.0]]).is_none());
        // Nearly so; and of very different sizes, which is no loss.
        assert!(none.renew(&[[1.0, 2.0], [2.0, 4.0001]]).is_none());
        assert!(none.renew(&[[1e-20, 1.0], [2.0, 4e20]]).is_some());
    }

    /// They serve until the corrections that they cost more would have paid for new ones: for more of them, the larger they are.
    #[test]
    fn they_are_renewed_when_they_have_cost_as_much() {
        fn served<const N: usize>(corrections: impl Fn(u32) -> u32) -> u32 {
            let unit: [[f64; N]; N] = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
            let mut derivatives = renewed(&unit);
            (0..1000)
                .take_while(|k| {
                    derivatives.took::<N>(corrections(*k));
                    !derivatives.stale
                })
                .count() as u32
        }
        assert_eq!(served::<3>(|_| 2), 1000);
        assert_eq!(served::<3>(|k| if k < 5 { 2 } else { 3 }), 5);
        // One more in every step, thirteen of which are worth new ones.
        assert_eq!(served::<7>(|k| if k < 5 { 2 } else { 3 }), 5 + 12);
    }

    /// A correction goes unseen where one as large was seen lately, with derivatives that are no longer new.
    #[test]
    fn what_was_seen_is_believed_for_a_while() {
        let unit = [[1.0, 0.0], [0.0, 1.0]];
        let mut derivatives = renewed(&unit);
        for _ in 0..OFTEN {
            derivatives.have_sufficed(1e-13, 1.0, || true);
            assert!(!derivatives.suffice(1e-14, 1.0), "too new");
            derivatives.took::<2>(2);
        }
        derivatives.have_sufficed(1e-13, 1.0, || false);
        assert!(!derivatives.suffice(1e-14, 1.0), "not sure");
        derivatives.have_sufficed(2.0 * SLIGHT, 1.0, || true);
        assert!(!derivatives.suffice(1e-14, 1.0), "too large");
        derivatives.have_sufficed(2e-13, 2.0, || true);
        assert!(derivatives.suffice(1e-13, 1.0) && !derivatives.suffice(1.1e-13, 1.0));
        for _ in 0..OFTEN {
            assert!(derivatives.suffice(1e-13, 1.0));
            derivatives.go_unseen();
        }
        assert!(!derivatives.suffice(1e-13, 1.0), "for too long");
        derivatives.have_sufficed(1e-14, 1.0, || true);
        assert!(derivatives.suffice(0.5e-13, 1.0) && !derivatives.suffice(0.6e-13, 1.0), "half of what it was");
        for forget in
            [Derivatives::have_not_sufficed, Derivatives::forget, |d: &mut Derivatives| d.renew(&[[2.0]]).unwrap()]
        {
            let mut other = derivatives;
            forget(&mut other);
            assert!(!other.suffice(1e-14, 1.0));
        }
    }

    /// Where the second search already costs as much, sixteen have their own.
    #[test]
    fn each_has_its_own_where_a_second_is_not_worth_it() {
        let unit = [[1.0, 0.0], [0.0, 1.0]];
        let mut derivatives = renewed(&unit);
        derivatives.took::<2>(2);
        derivatives.took::<2>(4);
        for _ in 0..16 {
            assert!(derivatives.stale);
            derivatives.renew(&unit).unwrap();
            derivatives.took::<2>(2);
        }
        assert!(derivatives.stale);
        derivatives.renew(&unit).unwrap();
        derivatives.took::<2>(2);
        assert!(!derivatives.stale, "then it is tried again");
    }
}
