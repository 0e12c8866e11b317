use crate::linear::{Lu, Singular, has_positive_determinant, normal_solve};
use crate::{AdmissibleBasis, Rows, from_fn, mapped};

/// The linear equations of a constrained system,
///
/// ```text
/// K x + G' lambda = r      (N equations)
/// C x             = c      (M equations)
/// ```
///
/// `G` is the constraint matrix at the point where the multipliers act, `C` the matrix of the constraint to be met.
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
    /// A pivot of the Schur complement below it, relative to its row and column, is round-off: each entry is a sum of `N`
    /// products, and up to `M` of them have been eliminated.
    pub(crate) const DEPENDENT: f64 = 4.0 * (N + M) as f64 * f64::EPSILON;

    /// Solves for `x` and `lambda`, in the basis of `ker G` if given, else with the multipliers.
    ///
    /// # Errors
    /// [`Singular`] where the equations do not determine a solution.
    #[inline]
    pub fn solve(&self, basis: Option<&AdmissibleBasis<f64, N, M>>) -> Result<([f64; N], [f64; M]), Singular> {
        self.solve_oriented(basis).map(|(x, lambda, _)| (x, lambda))
    }

    /// As [`solve`](Self::solve), with a third result: whether the determinant is positive. With a basis this is the determinant of the
    /// equations tested against the basis, followed by the constraints; else of the equations with multipliers.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    #[inline]
    pub fn solve_oriented(
        &self,
        basis: Option<&AdmissibleBasis<f64, N, M>>,
    ) -> Result<([f64; N], [f64; M], bool), Singular> {
        match basis {
            Some(basis) => self.solve_in_basis(basis),
            None => self.solve_with_multipliers(),
        }
    }

    /// Whether the determinant of [`solve_oriented`](Self::solve_oriented) is positive in a step of length zero, in which `K` is minus a
    /// positive mass matrix and `C` is `G`. On the branch of solutions that begins there the determinant keeps its sign until it
    /// vanishes.
    ///
    /// Tested against a basis `w` the matrix is `[-w' M; G]`, which times `[w, M^-1 G']` has the diagonal blocks `-w' M w` and
    /// `G M^-1 G'`; so but for `(-1)^(N-M)` it has the sign of `[w'; G]`, whatever `M`.
    ///
    /// Returns `None` if the basis vectors or the rows depend on one another.
    #[must_use]
    #[inline]
    pub fn is_positive_at_rest(transposed: &[[f64; N]; M], basis: Option<&AdmissibleBasis<f64, N, M>>) -> Option<bool> {
        let Some(basis) = basis else { return Some(N.is_multiple_of(2)) };
        let mut frame = [[0.0; N]; N];
        for (row, w) in frame.iter_mut().zip(basis.vectors().iter().chain(transposed)) {
            *row = *w;
        }
        let positive = has_positive_determinant(&frame)?;
        Some(positive == (N.is_multiple_of(2) == M.is_multiple_of(2)))
    }

    /// Tested against the basis `w` of `ker G` the multipliers drop out: `w . (K x) = w . r`, `C x = c`.
    fn solve_in_basis(&self, basis: &AdmissibleBasis<f64, N, M>) -> Result<([f64; N], [f64; M], bool), Singular> {
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
        let matrix = Lu::new(matrix)?;
        let x = matrix.solve(right);

        // What is left of the first equations lies in the span of G', and gives the multipliers.
        let rest = from_fn(|i| self.right[i] - dot(&self.block[i], &x));
        let lambda = normal_solve(&self.transposed, &rest)?;
        Ok((x, lambda, matrix.is_positive()))
    }

    /// The Schur complement `C K^-1 G'` gives the multipliers first.
    fn solve_with_multipliers(&self) -> Result<([f64; N], [f64; M], bool), Singular> {
        self.solve_by_schur(None)
    }

    /// Solves with some of the rows only: the other rows are not met, and their multipliers are zero.
    ///
    /// # Errors
    /// [`Singular`] if the remaining equations do not determine a solution.
    #[cold]
    #[inline(never)]
    pub fn solve_some(&self, rows: Rows) -> Result<([f64; N], [f64; M]), Singular> {
        self.solve_by_schur(Some(rows)).map(|(x, lambda, _)| (x, lambda))
    }

    #[inline(always)]
    fn solve_by_schur(&self, some: Option<Rows>) -> Result<([f64; N], [f64; M], bool), Singular> {
        let block = Lu::new(self.block)?;
        let free = block.solve(self.right);
        let response = mapped(&self.transposed, |g| block.solve(g));
        let mut schur: [[f64; M]; M] = from_fn(|k| from_fn(|l| dot(&self.rows[k], &response[l])));
        let mut right: [f64; M] = from_fn(|k| dot(&self.rows[k], &free) - self.level[k]);
        if let Some(some) = some {
            for k in (0..M).filter(|k| !some.contains(*k)) {
                for l in 0..M {
                    (schur[k][l], schur[l][k]) = (0.0, 0.0);
                }
                (schur[k][k], right[k]) = (1.0, 0.0);
            }
        }
        let schur = Lu::above(schur, Self::DEPENDENT)?;
        let lambda = schur.solve(right);
        let x = from_fn(|i| free[i] - (0..M).map(|k| response[k][i] * lambda[k]).sum::<f64>());
        // The determinant is that of K times that of -C K^-1 G'.
        let positive = block.is_positive() == (schur.is_positive() ^ !M.is_multiple_of(2));
        Ok((x, lambda, positive))
    }
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}
