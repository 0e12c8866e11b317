use lagrangian::linear::{Inverse, larger};
use lagrangian::{from_fn, mapped, mul_add};

/// Larger systems, by coordinates or constraints, have no frozen Jacobian: each of their steps is made without memory.
pub(crate) const COORDINATES: usize = 12;

/// The fewest evaluations of the residual in an iteration: one for the first correction, and one that finds the equations met.
pub(crate) const LEAST: u32 = 2;

pub(crate) type UnknownsRow = [f64; COORDINATES];

/// A frozen Jacobian: the inverse of a matrix of derivatives, by columns, which serves several steps (chord method).
///
/// It is renewed when the corrections that it cost in surplus take as long as a new one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub(crate) struct StepDerivatives {
    columns: [UnknownsRow; COORDINATES],
    /// The absolute values of the matrix itself, by rows.
    sizes: [UnknownsRow; COORDINATES],
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
}

impl StepDerivatives {
    pub(crate) const NONE: Self = Self {
        columns: [[0.0; COORDINATES]; COORDINATES],
        sizes: [[0.0; COORDINATES]; COORDINATES],
        positive: true,
        stale: true,
        least: 0,
        more: 0,
        searches: 0,
        own: 0,
    };

    /// Takes a new Jacobian, given by rows; `None` if it has no inverse, or an inverse that loses digits.
    #[inline(never)]
    pub(crate) fn renew<const N: usize>(&mut self, matrix: &[[f64; N]; N]) -> Option<()> {
        /// If more than three digits are lost, the step is made without memory.
        const CLEAR: f64 = 1e3;
        let inverse = Inverse::new(matrix).ok()?;
        // The diagonal of |K| |K^-1|, whatever the scale of rows and columns. (Skeel 1979, J. ACM 26, 494-526.)
        let mut condition = 0.0;
        for (j, column) in self.columns.iter_mut().take(N).enumerate() {
            let unit = from_fn(|i| f64::from(u8::from(i == j)));
            column[..N].copy_from_slice(&inverse.solve(&unit));
            condition = larger(condition, (0..N).map(|i| (matrix[j][i] * column[i]).abs()).sum());
        }
        for (sizes, row) in self.sizes.iter_mut().zip(matrix) {
            sizes[..N].copy_from_slice(&mapped(row, f64::abs));
        }
        self.positive = inverse.is_positive();
        (self.stale, self.more, self.searches) = (false, 0, 0);
        (condition <= CLEAR).then_some(())
    }

    /// Forgets the Jacobian.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        (self.stale, self.own) = (true, 0);
    }

    /// The size `sum_j |K_ij x_j|` of the terms of a component of `K x`.
    #[inline(always)]
    pub(crate) fn size_of_terms<const N: usize>(&self, i: usize, x: &[f64; N]) -> f64 {
        self.sizes[i].iter().zip(x).map(|(size, x)| size * x.abs()).sum()
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

    /// Records the number of corrections that a step took with it, and marks it stale if the surplus has reached the cost of a new one.
    #[inline(always)]
    pub(crate) fn took<const N: usize>(&mut self, corrections: u32) {
        // The cost of a new Jacobian in corrections, about: `(N/3)^3`, one for three coordinates.
        let price = const { (N * N * N).div_ceil(27) as u32 };
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
        let Self { columns, sizes, positive, stale, least, more, searches, own } = self;
        for matrix in [columns, sizes] {
            matrix.as_flattened_mut().iter_mut().for_each(&mut visit);
        }
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
