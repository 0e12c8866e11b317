use crate::AdmissibleBasis;
use crate::linear::{Lu, Singular, normal_solve};
use std::array::from_fn;

/// The linear equations of a constrained system,
///
/// ```text
/// K x + G' lambda = r      (N equations)
/// C x             = c      (M equations)
/// ```
///
/// with `G` the constraint matrix where the multipliers act, and `C` that of the constraint to be met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saddle<const N: usize, const M: usize> {
    /// `K`.
    pub block: [[f64; N]; N],
    /// The rows of `G`.
    pub transposed: [[f64; N]; M],
    /// The rows of `C`.
    pub rows: [[f64; N]; M],
    /// `r`.
    pub right: [f64; N],
    /// `c`.
    pub level: [f64; M],
}

impl<const N: usize, const M: usize> Saddle<N, M> {
    /// `x` and `lambda`, in the given basis of `ker G` where there is one and with the multipliers otherwise.
    ///
    /// # Errors
    /// [`Singular`] where the equations do not determine a solution.
    #[inline]
    pub fn solve(&self, basis: Option<&AdmissibleBasis<f64, N, M>>) -> Result<([f64; N], [f64; M]), Singular> {
        match basis {
            Some(basis) => self.solve_in_basis(basis),
            None => self.solve_with_multipliers(),
        }
    }

    /// Tested against the basis `w` of `ker G` the multipliers drop out: `w . (K x) = w . r`, `C x = c`.
    fn solve_in_basis(&self, basis: &AdmissibleBasis<f64, N, M>) -> Result<([f64; N], [f64; M]), Singular> {
        let mut matrix = [[0.0; N]; N];
        let mut right = [0.0; N];
        for (row, w) in basis.vectors().iter().enumerate() {
            for i in 0..N {
                right[row] += w[i] * self.right[i];
                for j in 0..N {
                    matrix[row][j] += w[i] * self.block[i][j];
                }
            }
        }
        for k in 0..M {
            matrix[N - M + k] = self.rows[k];
            right[N - M + k] = self.level[k];
        }
        let x = Lu::new(matrix)?.solve(right);

        // What is left of the first equations lies in the span of G', and gives the multipliers.
        let rest = from_fn(|i| self.right[i] - dot(&self.block[i], &x));
        let lambda = normal_solve(&self.transposed, &rest)?;
        Ok((x, lambda))
    }

    /// The Schur complement `C K^-1 G'` gives the multipliers first.
    fn solve_with_multipliers(&self) -> Result<([f64; N], [f64; M]), Singular> {
        let block = Lu::new(self.block)?;
        let free = block.solve(self.right);
        let response = self.transposed.map(|g| block.solve(g));
        let schur = from_fn(|k| from_fn(|l| dot(&self.rows[k], &response[l])));
        let lambda = Lu::new(schur)?.solve(from_fn(|k| dot(&self.rows[k], &free) - self.level[k]));
        let x = from_fn(|i| free[i] - (0..M).map(|k| response[k][i] * lambda[k]).sum::<f64>());
        Ok((x, lambda))
    }
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}
