//! Factorisations.

use crate::{from_fn, mapped};
use nalgebra::{ArrayStorage, SMatrix, SVector};
use thiserror::Error;

/// A matrix that does not determine the solution.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("singular matrix: pivot {pivot:e} in column {column}, relative to its row and column")]
pub struct Singular {
    /// The column whose pivot vanishes.
    pub column: usize,
    /// The pivot, relative to the largest entries of its row and column.
    pub pivot: f64,
}

/// A pivot below it, relative to its row and column, is round-off.
pub(crate) const THRESHOLD: f64 = 4.0 * f64::EPSILON;

/// A pivot of the matrix `C K^-1 G'` of `M` constraints on `N` unknowns below it, relative to its row and column, is round-off: each entry
/// is a sum of `N` products, and up to `M` of them have been eliminated.
pub(crate) const fn dependent(n: usize, m: usize) -> f64 {
    4.0 * (n + m) as f64 * f64::EPSILON
}

/// A factorisation `P A = L U` by elimination with scaled partial pivoting.
///
/// nalgebra's own bounds the sizes by a trait that no generic `N` can promise, and every signature up to the user's
/// would carry it; this one is tested against nalgebra's and faer's.
#[derive(Debug, Clone, Copy)]
pub struct Lu<const U: usize> {
    factors: [[f64; U]; U],
    order: [usize; U],
    positive: bool,
}

impl<const U: usize> Lu<U> {
    /// Factorises `matrix`, given by rows.
    ///
    /// # Errors
    /// [`Singular`] if a pivot, relative to the size of its row and column, is zero to rounding or NaN.
    #[inline]
    pub fn new(matrix: [[f64; U]; U]) -> Result<Self, Singular> {
        Self::above(matrix, THRESHOLD)
    }

    /// Factorises a matrix whose entries carry more round-off: pivots up to `threshold` count as zero.
    ///
    /// # Errors
    /// As [`Lu::new`].
    #[inline]
    pub fn above(matrix: [[f64; U]; U], threshold: f64) -> Result<Self, Singular> {
        let mut a = matrix;
        let mut order: [usize; U] = from_fn(|i| i);
        // Reciprocals of the largest entry of each row, and of each column of the matrix so scaled.
        let mut row = mapped(&a, |r| largest(&r).recip());
        let column: [f64; U] = from_fn(|j| largest(&from_fn::<_, U, _>(|i| a[i][j] * row[i])).recip());
        let mut positive = true;
        for k in 0..U {
            // Exchanged element by element, at indices that are known at compile time, so that the matrix can stay in registers.
            for i in k + 1..U {
                if (a[i][k] * row[i]).abs() > (a[k][k] * row[k]).abs() {
                    a.swap(k, i);
                    row.swap(k, i);
                    order.swap(k, i);
                    positive = !positive;
                }
            }
            let pivot = (a[k][k] * row[k] * column[k]).abs();
            if pivot <= threshold || !pivot.is_finite() {
                // With finite entries it is NaN only where a row or a column is zero, and has no scale.
                let empty = !pivot.is_finite() && a.as_flattened().iter().all(|x| x.is_finite());
                return Err(Singular { column: k, pivot: if empty { 0.0 } else { pivot } });
            }
            positive ^= a[k][k] < 0.0;
            for i in k + 1..U {
                let factor = a[i][k] / a[k][k];
                a[i][k] = factor;
                for j in k + 1..U {
                    a[i][j] -= factor * a[k][j];
                }
            }
        }
        Ok(Self { factors: a, order, positive })
    }

    /// Whether the determinant is positive.
    #[must_use]
    #[inline(always)]
    pub fn is_positive(&self) -> bool {
        self.positive
    }

    /// The solution `x` of `A x = b`.
    #[must_use]
    #[inline]
    pub fn solve(&self, b: [f64; U]) -> [f64; U] {
        let mut x = mapped(&self.order, |i| b[i]);
        for i in 0..U {
            for j in 0..i {
                x[i] -= self.factors[i][j] * x[j];
            }
        }
        for i in (0..U).rev() {
            for j in i + 1..U {
                x[i] -= self.factors[i][j] * x[j];
            }
            x[i] /= self.factors[i][i];
        }
        x
    }
}

/// The inverse of a matrix of up to three rows that is far from singular, or the factorisation of any other: to solve with
/// it several times, and quickly.
#[derive(Debug, Clone, Copy)]
pub enum Inverse<const U: usize> {
    /// The rows of the inverse, by cofactors, and its determinant.
    Cofactors([[f64; U]; U], f64),
    /// The factorisation.
    Factors(Lu<U>),
}

impl<const U: usize> Inverse<U> {
    /// The determinant against the sum of the sizes of its terms: above it three digits of sixteen are lost to
    /// cancellation, whatever the scale of rows and columns.
    const CLEAR: f64 = 1e-3;

    /// The inverse of a matrix given by rows.
    ///
    /// # Errors
    /// As [`Lu::new`].
    #[inline(always)]
    pub fn new(a: &[[f64; U]; U]) -> Result<Self, Singular> {
        Self::above(a, THRESHOLD)
    }

    /// The inverse of a matrix whose entries carry more round-off: pivots up to `threshold` count as zero.
    ///
    /// # Errors
    /// As [`Lu::new`].
    #[inline(always)]
    pub fn above(a: &[[f64; U]; U], threshold: f64) -> Result<Self, Singular> {
        match Self::by_cofactors(a) {
            Some(inverse) => Ok(inverse),
            None => Self::factorised(a, threshold),
        }
    }

    /// As `above`, but `None` if the elimination of up to three rows loses more than three digits. For more rows the loss is not checked.
    #[inline(always)]
    pub(crate) fn clear_above(a: &[[f64; U]; U], threshold: f64) -> Option<Self> {
        // Decided by the number of rows alone, at compile time: a result that may be of either kind would be stored and loaded again,
        // with the latency of store forwarding.
        match U {
            0..=3 => Self::by_cofactors(a),
            _ => Self::factorised(a, threshold).ok(),
        }
    }

    #[inline(never)]
    fn factorised(a: &[[f64; U]; U], threshold: f64) -> Result<Self, Singular> {
        Lu::above(*a, threshold).map(Self::Factors)
    }

    #[inline(always)]
    fn by_cofactors(a: &[[f64; U]; U]) -> Option<Self> {
        let mut inverse = [[0.0; U]; U];
        let (determinant, terms) = match U {
            1 => {
                inverse[0][0] = 1.0;
                (a[0][0], a[0][0].abs())
            }
            2 => {
                (inverse[0][0], inverse[0][1]) = (a[1][1], -a[0][1]);
                (inverse[1][0], inverse[1][1]) = (-a[1][0], a[0][0]);
                let [p, q] = [a[0][0] * a[1][1], a[0][1] * a[1][0]];
                (p - q, p.abs() + q.abs())
            }
            3 => {
                let (mut determinant, mut terms) = (0.0, 0.0);
                for j in 0..3 {
                    let (k, l) = ((j + 1) % 3, (j + 2) % 3);
                    for i in 0..3 {
                        let (m, n) = ((i + 1) % 3, (i + 2) % 3);
                        let [p, q] = [a[m][k] * a[n][l], a[m][l] * a[n][k]];
                        inverse[j][i] = p - q;
                        if i == 0 {
                            determinant += a[0][j] * (p - q);
                            terms += a[0][j].abs() * (p.abs() + q.abs());
                        }
                    }
                }
                (determinant, terms)
            }
            _ => return None,
        };
        let clear = determinant.abs() > Self::CLEAR * terms && terms.is_finite();
        let scale = determinant.recip();
        if !(clear && scale.is_finite()) {
            return None;
        }
        for row in &mut inverse {
            for x in row {
                *x *= scale;
            }
        }
        Some(Self::Cofactors(inverse, scale))
    }

    /// Whether the determinant is positive.
    #[must_use]
    #[inline(always)]
    pub fn is_positive(&self) -> bool {
        match self {
            Self::Cofactors(_, determinant) => *determinant > 0.0,
            Self::Factors(lu) => lu.is_positive(),
        }
    }

    /// The solution `x` of `A x = b`.
    #[must_use]
    #[inline(always)]
    pub fn solve(&self, b: &[f64; U]) -> [f64; U] {
        match self {
            Self::Cofactors(inverse, _) => mapped(inverse, |row| (0..U).map(|i| row[i] * b[i]).sum()),
            Self::Factors(lu) => lu.solve(*b),
        }
    }
}

/// Whether the determinant of a matrix, given by rows, is positive; `None` if the determinant is zero or NaN.
///
/// Matrices of up to four rows are expanded, which costs a fraction of a factorisation and does not depend on the scale of rows and
/// columns.
#[must_use]
#[inline]
pub fn has_positive_determinant<const U: usize>(a: &[[f64; U]; U]) -> Option<bool> {
    let minor = |i: usize, j: usize, k: usize, l: usize| a[i][k] * a[j][l] - a[i][l] * a[j][k];
    let determinant = match U {
        1 => a[0][0],
        2 => minor(0, 1, 0, 1),
        3 => a[0][0] * minor(1, 2, 1, 2) - a[0][1] * minor(1, 2, 0, 2) + a[0][2] * minor(1, 2, 0, 1),
        4 => {
            minor(0, 1, 0, 1) * minor(2, 3, 2, 3) - minor(0, 1, 0, 2) * minor(2, 3, 1, 3)
                + minor(0, 1, 0, 3) * minor(2, 3, 1, 2)
                + minor(0, 1, 1, 2) * minor(2, 3, 0, 3)
                - minor(0, 1, 1, 3) * minor(2, 3, 0, 2)
                + minor(0, 1, 2, 3) * minor(2, 3, 0, 1)
        }
        _ => return Lu::new(*a).ok().map(|lu| lu.is_positive()),
    };
    (determinant.abs() > 0.0).then_some(determinant > 0.0)
}

/// The larger of `m` and `|x|`. A NaN in `x` is returned, whereas `f64::max` would drop it.
#[must_use]
#[inline(always)]
pub fn larger(m: f64, x: f64) -> f64 {
    let size = x.abs();
    if size > m || size.is_nan() { size } else { m }
}

/// The largest `|x_i|` of a vector; NaN if a component is NaN.
#[must_use]
#[inline(always)]
pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| larger(m, *x))
}

/// The least-squares solution `lambda` of `A' lambda = b`, `A` given by its `M` rows: `(A A') lambda = A b`.
///
/// # Errors
/// [`Singular`] if the rows of `A` depend on one another.
#[inline]
pub fn normal_solve<const N: usize, const M: usize>(rows: &[[f64; N]; M], b: &[f64; N]) -> Result<[f64; M], Singular> {
    if M == 1 {
        let along = |x: &[f64; N]| (0..N).map(|i| rows[0][i] * x[i]).sum::<f64>();
        let (square, level) = (along(&rows[0]), along(b));
        // Also where the square is not a number, or leaves the range of numbers.
        let usual = square > 0.0 && square.is_finite();
        return if usual { Ok([level / square; M]) } else { Err(Singular { column: 0, pivot: 0.0 }) };
    }
    let transposed: SMatrix<f64, N, M> = SMatrix::from_array_storage(ArrayStorage(*rows));
    let gram = transposed.tr_mul(&transposed);
    let right: SVector<f64, M> = transposed.tr_mul(&SVector::from(*b));
    let factor = gram.cholesky().ok_or(Singular { column: M.saturating_sub(1), pivot: 0.0 })?;
    for k in 0..M {
        // What is left of a row without the part along the rows before it.
        let pivot = factor.l_dirty()[(k, k)].powi(2) / gram[(k, k)];
        if pivot <= THRESHOLD || pivot.is_nan() {
            return Err(Singular { column: k, pivot });
        }
    }
    let [lambda] = factor.solve(&right).data.0;
    Ok(lambda)
}

/// The product of two vectors.
#[inline(always)]
pub(crate) fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}
