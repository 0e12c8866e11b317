use crate::linear::{Inverse, Singular};
use crate::{AdmissibleBasis, Saddle};
use std::array::from_fn;

/// The matrices of a [`Saddle`], factorised for several right-hand sides: for simplified Newton iterations, which keep the
/// derivatives of an earlier point.
#[derive(Debug, Clone, Copy)]
pub struct FactoredSaddle<const N: usize, const M: usize> {
    /// `[w' K; C]` in a basis `w` of `ker G`, or `K`.
    matrix: Inverse<N>,
    /// `K^-1 G'` and the inverse of `C K^-1 G'`, with multipliers.
    schur: Option<([[f64; N]; M], Inverse<M>)>,
}

impl<const N: usize, const M: usize> FactoredSaddle<N, M> {
    /// The matrices of the equations, in the given basis of `ker G` where there is one and with multipliers otherwise.
    ///
    /// # Errors
    /// [`Singular`] where they do not determine a solution.
    #[inline(always)]
    pub fn new(
        block: &[[f64; N]; N],
        transposed: &[[f64; N]; M],
        rows: &[[f64; N]; M],
        basis: Option<&AdmissibleBasis<f64, N, M>>,
    ) -> Result<Self, Singular> {
        if let Some(basis) = basis {
            let mut matrix = [[0.0; N]; N];
            for (row, w) in matrix.iter_mut().zip(basis.vectors()) {
                *row = from_fn(|j| (0..N).map(|i| w[i] * block[i][j]).sum());
            }
            matrix[N - M..].copy_from_slice(rows);
            return Ok(Self { matrix: Inverse::new(&matrix)?, schur: None });
        }
        let matrix = Inverse::new(block)?;
        let response = transposed.map(|g| matrix.solve(&g));
        let schur: [[f64; M]; M] = from_fn(|k| from_fn(|l| dot(&rows[k], &response[l])));
        let schur = Inverse::above(&schur, Saddle::<N, M>::DEPENDENT)?;
        Ok(Self { matrix, schur: Some((response, schur)) })
    }

    /// Whether the determinant is positive, as [`Saddle::solve_oriented`] tells it.
    #[must_use]
    #[inline(always)]
    pub fn is_positive(&self) -> bool {
        match &self.schur {
            None => self.matrix.is_positive(),
            // That of K times that of -C K^-1 G'.
            Some((_, schur)) => self.matrix.is_positive() == (schur.is_positive() ^ !M.is_multiple_of(2)),
        }
    }

    /// `x` of `K x + G' lambda = right`, `C x = level`, with the basis, the rows of `C` and the matrices given before.
    #[must_use]
    #[inline(always)]
    pub fn solve(
        &self,
        right: &[f64; N],
        level: &[f64; M],
        rows: &[[f64; N]; M],
        basis: Option<&AdmissibleBasis<f64, N, M>>,
    ) -> [f64; N] {
        match (&self.schur, basis) {
            (None, Some(basis)) => {
                let mut tested = [0.0; N];
                for (place, w) in tested.iter_mut().zip(basis.vectors()) {
                    *place = dot(w, right);
                }
                tested[N - M..].copy_from_slice(level);
                self.matrix.solve(&tested)
            }
            (Some((response, schur)), _) => {
                let free = self.matrix.solve(right);
                let lambda = schur.solve(&from_fn(|k| dot(&rows[k], &free) - level[k]));
                from_fn(|i| free[i] - (0..M).map(|k| response[k][i] * lambda[k]).sum::<f64>())
            }
            (None, None) => self.matrix.solve(right),
        }
    }
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}
