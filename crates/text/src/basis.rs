//! A basis of the admissible velocities by elimination, where a text gives none.

use crate::MOST_CONSTRAINTS;
use lagrangian::Scalar;
use nalgebra::DMatrix;

/// Which rate each constraint is solved for, in the order of the elimination.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pivots {
    /// Rows with their columns.
    order: [(u8, u8); MOST_CONSTRAINTS],
    count: u8,
}

impl Pivots {
    /// Those that are best conditioned for these rows: by elimination with complete pivoting, of rows of length one and of columns in the
    /// sizes of their rates, so that neither the scale of a constraint nor the unit of a coordinate counts.
    pub(crate) fn best(rows: &DMatrix<f64>, sizes: &[f64]) -> Self {
        let (m, n) = rows.shape();
        let mut a = rows.clone();
        for (mut column, size) in a.column_iter_mut().zip(sizes) {
            column.scale_mut(*size);
        }
        for mut row in a.row_iter_mut() {
            let length = row.norm();
            if length > 0.0 && length.is_finite() {
                row.unscale_mut(length);
            }
        }
        let mut pivots = Self { order: [(0, 0); MOST_CONSTRAINTS], count: m as u8 };
        let (mut left, mut free): (Vec<usize>, Vec<usize>) = ((0..m).collect(), (0..n).collect());
        for place in &mut pivots.order[..m] {
            let all = left.iter().flat_map(|&r| free.iter().map(move |&c| (r, c)));
            let size = |(r, c): (usize, usize)| a[(r, c)].abs();
            // The first of equals; what is not a number is no pivot.
            let best = all.reduce(|best, other| if size(other) > size(best) { other } else { best });
            let Some((r, c)) = best else { break };
            *place = (r as u8, c as u8);
            left.retain(|&other| other != r);
            free.retain(|&other| other != c);
            for &i in &left {
                let factor = a[(i, c)] / a[(r, c)];
                for &j in &free {
                    let change = factor * a[(r, j)];
                    a[(i, j)] -= change;
                }
            }
        }
        pivots
    }

    /// A whole number that says all of it, from one on.
    pub(crate) fn number(&self) -> u64 {
        1 + self.order().fold(0, |number, (r, c)| number << 7 | (r as u64) << 4 | c as u64)
    }

    /// Those with that number, of so many rows.
    pub(crate) fn numbered(number: u64, rows: usize) -> Self {
        let mut pivots = Self { order: [(0, 0); MOST_CONSTRAINTS], count: rows as u8 };
        let mut rest = number.saturating_sub(1);
        for place in pivots.order[..rows].iter_mut().rev() {
            *place = ((rest >> 4 & 7) as u8, (rest & 15) as u8);
            rest >>= 7;
        }
        pivots
    }

    /// Whether the rates that are solved for stay within so many times those that are free, each in its size.
    pub(crate) fn are_good<const N: usize, const M: usize>(
        &self,
        n: usize,
        rows: [[f64; N]; M],
        sizes: &[f64],
    ) -> bool {
        /// Where a rate becomes so many times the others, another one is solved for: its best value is about one.
        const MOST: f64 = 3.0;
        let vectors = self.basis(n, rows);
        let solved =
            |vector: &[f64; N], i: usize| self.order().all(|(_, c)| (vector[c] * sizes[i]).abs() <= MOST * sizes[c]);
        vectors.iter().zip(self.free(n)).all(|(vector, i)| solved(vector, i))
    }

    /// Rows with their columns, in the order of the elimination.
    pub(crate) fn order(&self) -> impl Iterator<Item = (usize, usize)> {
        self.order[..usize::from(self.count)].iter().map(|&(r, c)| (usize::from(r), usize::from(c)))
    }

    /// The coordinates whose rates are free.
    pub(crate) fn free(&self, n: usize) -> impl Iterator<Item = usize> {
        (0..n).filter(|&i| self.order().all(|(_, c)| c != i))
    }

    /// The velocities that these rows admit, one for each free rate: with that rate one, and the other free rates zero.
    pub(crate) fn basis<S: Scalar, const N: usize, const M: usize>(&self, n: usize, mut a: [[S; N]; M]) -> [[S; N]; N] {
        for (r, c) in self.order() {
            let inverse = a[r][c].recip();
            for x in &mut a[r][..n] {
                *x = *x * inverse;
            }
            let row = a[r];
            for (i, other) in a.iter_mut().enumerate().take(usize::from(self.count)) {
                let factor = other[c];
                // Rows are sparse, and what vanishes with its derivatives changes nothing.
                if i != r && !factor.is_zero() {
                    for j in 0..n {
                        other[j] -= factor * row[j];
                    }
                }
            }
        }
        let mut vectors = [[S::zero(); N]; N];
        for (vector, i) in vectors.iter_mut().zip(self.free(n)) {
            vector[i] = S::constant(1.0);
            for (r, c) in self.order() {
                vector[c] = -a[r][i];
            }
        }
        vectors
    }
}
