use crate::linear::{Inverse, Lu, Singular, dependent, dot, has_positive_determinant, normal_solve};
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
    /// Solves for `x` and `lambda`, in the basis of `ker G` if given, else with the multipliers.
    ///
    /// # Errors
    /// [`Singular`] where the equations do not determine a solution.
    #[inline(never)]
    pub fn solve(&self, basis: Option<&AdmissibleBasis<f64, N, M>>) -> Result<([f64; N], [f64; M]), Singular> {
        match basis {
            Some(basis) => self.solve_in_basis(basis),
            None => self.solve_by_schur(None),
        }
    }

    /// Solves with some of the rows only: the other rows are not met, and their multipliers are zero.
    ///
    /// # Errors
    /// [`Singular`] if the remaining equations do not determine a solution.
    #[cold]
    #[inline(never)]
    pub fn solve_some(&self, rows: Rows) -> Result<([f64; N], [f64; M]), Singular> {
        self.solve_by_schur(Some(rows))
    }

    /// Whether the determinant of [`FactoredSaddle::is_positive`] is positive in a step of length zero, in which `K` is minus a
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
    #[inline(always)]
    fn solve_by_schur(&self, some: Option<Rows>) -> Result<([f64; N], [f64; M]), Singular> {
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
        let lambda = Lu::above(schur, dependent(N, M))?.solve(right);
        let x = from_fn(|i| free[i] - (0..M).map(|k| response[k][i] * lambda[k]).sum::<f64>());
        Ok((x, lambda))
    }
}

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
        Ok(Self { rows: *rows, response, schur: Inverse::above(&schur, dependent(N, M))? })
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
        Some(Self { rows: *rows, response, schur: Inverse::clear_above(&schur, dependent(N, M))? })
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

/// The matrices of a [`Saddle`], factorised for several right-hand sides: for simplified Newton iterations, which keep the
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

    /// Whether the determinant is positive: of the matrix `[w' K; C]` in a basis, else of the equations with
    /// multipliers.
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
