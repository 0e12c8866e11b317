use crate::linear::{Inverse, Singular};
use crate::{Saddle, from_fn};

/// The equations of a [`Saddle`] with known `K^-1`: its Schur complement `C K^-1 G'`, factorised for several right-hand sides.
#[derive(Debug, Clone, Copy)]
pub struct Bordered<const N: usize, const M: usize> {
    /// The rows of `C`.
    rows: [[f64; N]; M],
    /// `K^-1 G'`, by the rows of `G`.
    response: [[f64; N]; M],
    /// The inverse of `C K^-1 G'`.
    schur: Inverse<M>,
}

impl<const N: usize, const M: usize> Bordered<N, M> {
    /// The equations with the solver `inverse` for `K^-1`, the rows `transposed` of `G` and the `rows` of `C`.
    ///
    /// # Errors
    /// [`Singular`] if the equations do not determine a solution.
    #[inline(always)]
    pub fn new(
        inverse: impl Fn(&[f64; N]) -> [f64; N],
        transposed: &[[f64; N]; M],
        rows: &[[f64; N]; M],
    ) -> Result<Self, Singular> {
        let (response, schur) = Self::eliminated(inverse, transposed, rows);
        Ok(Self { rows: *rows, response, schur: Inverse::above(&schur, Saddle::<N, M>::DEPENDENT)? })
    }

    /// The same equations, or `None` if the elimination of up to three multipliers loses more than three digits, whatever the scale of
    /// the rows. For more multipliers the loss is not checked.
    #[inline(always)]
    pub fn clear(
        inverse: impl Fn(&[f64; N]) -> [f64; N],
        transposed: &[[f64; N]; M],
        rows: &[[f64; N]; M],
    ) -> Option<Self> {
        let (response, schur) = Self::eliminated(inverse, transposed, rows);
        Some(Self { rows: *rows, response, schur: Inverse::clear_above(&schur, Saddle::<N, M>::DEPENDENT)? })
    }

    /// `K^-1 G'`, by the rows of `G`, and `C K^-1 G'`.
    #[inline(always)]
    fn eliminated(
        inverse: impl Fn(&[f64; N]) -> [f64; N],
        transposed: &[[f64; N]; M],
        rows: &[[f64; N]; M],
    ) -> ([[f64; N]; M], [[f64; M]; M]) {
        let response: [[f64; N]; M] = from_fn(|k| inverse(&transposed[k]));
        let schur = from_fn(|k| from_fn(|l| dot(&rows[k], &response[l])));
        (response, schur)
    }

    /// Whether the determinant of the equations, `det K det(-C K^-1 G')`, is positive; `block` tells whether `det K` is positive.
    #[must_use]
    #[inline(always)]
    pub fn is_positive(&self, block: bool) -> bool {
        block == (self.schur.is_positive() ^ !M.is_multiple_of(2))
    }

    /// Whether the determinant has the sign of [`Saddle::is_positive_at_rest`].
    #[must_use]
    #[inline(always)]
    pub fn is_as_at_rest(&self, block: bool) -> bool {
        self.is_positive(block) == N.is_multiple_of(2)
    }

    /// `x` and `lambda` of `K x + G' lambda = r`, `C x = level`, given `free = K^-1 r`.
    #[must_use]
    #[inline(always)]
    pub fn solve(&self, free: &[f64; N], level: &[f64; M]) -> ([f64; N], [f64; M]) {
        let lambda = self.schur.solve(&from_fn(|k| dot(&self.rows[k], free) - level[k]));
        let mut x = *free;
        for k in 0..M {
            for i in 0..N {
                x[i] -= self.response[k][i] * lambda[k];
            }
        }
        (x, lambda)
    }
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}
