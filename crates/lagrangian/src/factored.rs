use crate::linear::{Inverse, Singular};
use crate::{AdmissibleBasis, Bordered, from_fn};

/// The matrices of a [`Saddle`](crate::Saddle), factorised for several right-hand sides: for simplified Newton iterations, which keep the
/// derivatives of an earlier point.
#[derive(Debug, Clone, Copy)]
pub struct FactoredSaddle<const N: usize, const M: usize> {
    /// `[w' K; C]` in a basis `w` of `ker G`, or `K`.
    matrix: Inverse<N>,
    /// With multipliers.
    bordered: Option<Bordered<N, M>>,
}

impl<const N: usize, const M: usize> FactoredSaddle<N, M> {
    /// The matrices of the equations, in the basis of `ker G` if given, else with the multipliers.
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
            return Ok(Self { matrix: Inverse::new(&matrix)?, bordered: None });
        }
        let matrix = Inverse::new(block)?;
        let bordered = Bordered::new(
            #[inline(always)]
            |g| matrix.solve(g),
            transposed,
            rows,
        )?;
        Ok(Self { matrix, bordered: Some(bordered) })
    }

    /// Whether the determinant is positive, as [`Saddle::solve_oriented`](crate::Saddle::solve_oriented) tells it.
    #[must_use]
    #[inline(always)]
    pub fn is_positive(&self) -> bool {
        let block = self.matrix.is_positive();
        self.bordered.as_ref().map_or(block, |bordered| bordered.is_positive(block))
    }

    /// `x` of `K x + G' lambda = right`, `C x = level`, with the basis and the matrices given before.
    #[must_use]
    #[inline(always)]
    pub fn solve(&self, right: &[f64; N], level: &[f64; M], basis: Option<&AdmissibleBasis<f64, N, M>>) -> [f64; N] {
        let mut right = *right;
        if let (None, Some(basis)) = (&self.bordered, basis) {
            let given = right;
            for (place, w) in right.iter_mut().zip(basis.vectors()) {
                *place = dot(w, &given);
            }
            right[N - M..].copy_from_slice(level);
        }
        let free = self.matrix.solve(&right);
        self.bordered.as_ref().map_or(free, |bordered| bordered.solve(&free, level).0)
    }
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}
