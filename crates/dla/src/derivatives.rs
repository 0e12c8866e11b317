use lagrangian::linear::{Inverse, larger};
use lagrangian::{from_fn, mul_add};

/// Larger systems, by coordinates or constraints, have no frozen Jacobian: each of their steps is made without memory.
pub(crate) const COORDINATES: usize = 12;

/// Maximum number of corrections in a row that are accepted without a check of their residual, and least number of steps with the same
/// Jacobian before the first one.
const OFTEN: u32 = 16;
/// A correction above this fraction of the unknowns is always checked: the predictor was then off by more than round-off.
const SLIGHT: f64 = 1e-12;

pub(crate) type UnknownsRow = [f64; COORDINATES];

/// A frozen Jacobian: the inverse of a matrix of derivatives, by columns, which serves several steps (chord method).
///
/// It is renewed when the corrections that it cost in surplus take as long as a new one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub(crate) struct StepDerivatives {
    columns: [UnknownsRow; COORDINATES],
    /// Whether its determinant is positive.
    pub(crate) positive: bool,
    /// Whether it is to be renewed.
    pub(crate) stale: bool,
    /// The corrections that the first step with it took, and how many more all later steps took together.
    least: u32,
    more: u32,
    /// The number of steps it has served.
    searches: u32,
    /// The number of coming steps in which it is renewed every time.
    own: u32,
    /// The largest correction, relative to the unknowns, after which a check found a residual of round-off; and the number of corrections
    /// accepted without a check since.
    seen: f64,
    unseen: u32,
}

impl StepDerivatives {
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

    /// Takes a new Jacobian, given by rows; `None` if it has no inverse, or an inverse that loses digits.
    #[inline(never)]
    pub(crate) fn renew<const N: usize>(&mut self, matrix: &[[f64; N]; N]) -> Option<()> {
        /// If more than three digits are lost, the step is made without memory, perhaps in a basis that keeps them.
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

    /// Forgets the Jacobian.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        (self.stale, self.own, self.seen) = (true, 0, 0.0);
    }

    /// Whether a correction of the size `d` of unknowns of the size `x` may be accepted without a check, since a check of one as large has
    /// shown a residual of round-off. The residual after a correction is a part of it that grows with the age of the Jacobian; between
    /// two checks it does not grow beyond twice. (Rates of contraction are remembered likewise, Hairer and Wanner 1996, IV.8.)
    #[inline(always)]
    pub(crate) fn suffice(&self, d: f64, x: f64) -> bool {
        d <= self.seen * x && self.unseen < OFTEN
    }

    /// Counts a correction that was accepted without a check.
    #[inline(always)]
    pub(crate) fn go_unseen(&mut self) {
        self.unseen = self.unseen.saturating_add(1);
    }

    /// Records that a check of a correction of the size `d` of unknowns of the size `x` found round-off, if `sure` confirms it. Older
    /// records count half at every new one.
    #[inline(always)]
    pub(crate) fn have_sufficed(&mut self, d: f64, x: f64, sure: impl FnOnce() -> bool) {
        if d <= SLIGHT * x && self.searches >= OFTEN && sure() {
            (self.seen, self.unseen) = (larger(d / x, 0.5 * self.seen), 0);
        }
    }

    /// Records that a check found more than round-off.
    #[inline(always)]
    pub(crate) fn have_not_sufficed(&mut self) {
        self.seen = 0.0;
    }

    /// The product of the inverse with a vector.
    #[inline(always)]
    pub(crate) fn times<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        match N {
            0..=4 => self.times_of::<N, N>(x),
            5..=8 => self.times_of::<N, 8>(x),
            _ => self.times_of::<N, COORDINATES>(x),
        }
    }

    /// The same product by columns padded to `W` entries: beyond four, whole vector registers are quicker.
    #[inline(always)]
    fn times_of<const N: usize, const W: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let mut sum = [0.0; W];
        for (column, x) in self.columns.iter().zip(x) {
            for i in 0..W {
                // In short columns, the chain of dependent operations is one addition a column if products are not fused into it.
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

    /// Records the number of corrections that a step took with it, and marks it stale if the surplus has reached the cost of a new one.
    #[inline(always)]
    pub(crate) fn took<const N: usize>(&mut self, corrections: u32) {
        // The cost of a new Jacobian in corrections, about: `(N/3)^3`, one for three coordinates.
        let price = const { (N * N * N).div_ceil(27) as u32 };
        self.took_at(price, corrections);
    }

    /// As [`Self::took`], in the basis of admissible velocities: a step there takes one correction more now and then although the Jacobian
    /// is no older, since the basis itself turns within the step.
    #[inline(always)]
    pub(crate) fn took_in_basis<const N: usize>(&mut self, corrections: u32) {
        let price = const { 8 + (N * N * N).div_ceil(27) as u32 };
        self.took_at(price, corrections);
    }

    #[inline(always)]
    fn took_at(&mut self, price: u32, corrections: u32) {
        /// Number of steps in a row that renew their Jacobian, after already the second step with one reached its cost.
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

    /// Visits every number of it, in a fixed order.
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
    // A number from a file that is not a count saturates to one.
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

    fn renewed<const N: usize>(matrix: &[[f64; N]; N]) -> StepDerivatives {
        let mut derivatives = StepDerivatives::NONE;
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
        let mut none = StepDerivatives::NONE;
        assert!(none.renew(&[[1.0, 2.0], [2.0, 4.0]]).is_none());
        // Nearly so; and of very different sizes, which is no loss.
        assert!(none.renew(&[[1.0, 2.0], [2.0, 4.0001]]).is_none());
        assert!(none.renew(&[[1e-20, 1.0], [2.0, 4e20]]).is_some());
    }

    /// It serves until its surplus of corrections would have paid for a new one: the larger the matrix, the more of them.
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

    /// A correction is accepted without a check if one as large was checked lately, with a Jacobian that is no longer new.
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
        for forget in [StepDerivatives::have_not_sufficed, StepDerivatives::forget, |d: &mut StepDerivatives| {
            d.renew(&[[2.0]]).unwrap();
        }] {
            let mut other = derivatives;
            forget(&mut other);
            assert!(!other.suffice(1e-14, 1.0));
        }
    }

    /// Where already the second step reaches the cost, sixteen have a Jacobian of their own.
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
