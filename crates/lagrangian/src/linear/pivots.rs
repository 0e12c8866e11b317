//! A basis of the admissible velocities by elimination, where a system gives none.

use crate::Scalar;
use nalgebra::DMatrix;

/// Pivots are replaced if a solved rate exceeds `MOST` times a free rate, or an entry exceeds `MOST` times a pivot. The best value of
/// both ratios is about one.
const MOST: f64 = 3.0;

/// The rate for which each constraint is solved, in the order of the elimination.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pivots {
    /// Rows with their columns.
    order: [(u8, u8); Self::MOST_ROWS],
    count: u8,
}

impl Pivots {
    /// Maximum number of constraints with pivots: seven bits encode the row and the column of each, so their [number](Self::number) is
    /// exact in an `f64` with its 53 bits.
    pub const MOST_ROWS: usize = 7;
    /// Maximum number of coordinates with pivots.
    pub const MOST_COLUMNS: usize = 16;

    /// The best conditioned pivots for these rows, by elimination with complete pivoting. Rows are scaled to length one and columns by the
    /// sizes of their rates, so neither the scale of a constraint nor the unit of a coordinate matters.
    ///
    /// `rows` has one row for each constraint and one column for each coordinate. Rows beyond [`MOST_ROWS`](Self::MOST_ROWS) and columns
    /// beyond [`MOST_COLUMNS`](Self::MOST_COLUMNS) get no pivot.
    #[must_use]
    pub fn best(rows: &DMatrix<f64>, sizes: &[f64]) -> Self {
        let (m, n) = rows.shape();
        let (m, n) = (m.min(Self::MOST_ROWS), n.min(Self::MOST_COLUMNS));
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
        let mut pivots = Self { order: [(0, 0); Self::MOST_ROWS], count: m as u8 };
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

    /// The rates that have the same kinetic energy, if `masses` is the diagonal of the mass matrix.
    pub fn sizes(masses: impl IntoIterator<Item = f64>) -> impl Iterator<Item = f64> {
        // A rate without kinetic energy has the size one.
        masses.into_iter().map(|mass| if mass > 0.0 && mass.is_finite() { mass.sqrt().recip() } else { 1.0 })
    }

    /// The pivots encoded as one whole number, at least 1.
    #[must_use]
    pub fn number(&self) -> u64 {
        1 + self.order().fold(0, |number, (r, c)| number << 7 | (r as u64) << 4 | c as u64)
    }

    /// The pivots of `rows` constraints with this [number](Self::number).
    #[must_use]
    pub fn numbered(number: u64, rows: usize) -> Self {
        let rows = rows.min(Self::MOST_ROWS);
        let mut pivots = Self { order: [(0, 0); Self::MOST_ROWS], count: rows as u8 };
        let mut rest = number.saturating_sub(1);
        for place in pivots.order[..rows].iter_mut().rev() {
            *place = ((rest >> 4 & 7) as u8, (rest & 15) as u8);
            rest >>= 7;
        }
        pivots
    }

    /// Whether each solved rate is at most `MOST` times each free rate, both in units of their sizes, and no pivot is much smaller than
    /// another entry that could replace it.
    #[must_use]
    pub fn are_good<const N: usize, const M: usize>(&self, n: usize, rows: [[f64; N]; M], sizes: &[f64]) -> bool {
        let vectors = self.basis(n, rows);
        let solved =
            |vector: &[f64; N], i: usize| self.order().all(|(_, c)| (vector[c] * sizes[i]).abs() <= MOST * sizes[c]);
        self.are_large(n, rows, sizes) && vectors.iter().zip(self.free(n)).all(|(vector, i)| solved(vector, i))
    }

    /// Whether each pivot is one of the larger entries that are left of the rows and columns of all pivots, both in their sizes. (Two rates
    /// may be the right ones to solve for, and the order the wrong one.)
    fn are_large<const N: usize, const M: usize>(&self, n: usize, mut a: [[f64; N]; M], sizes: &[f64]) -> bool {
        for row in &mut a {
            row.iter_mut().zip(sizes).for_each(|(x, size)| *x *= size);
            let length = row[..n].iter().map(|x| x * x).sum::<f64>().sqrt();
            row.iter_mut().for_each(|x| *x /= length);
        }
        for (place, (r, c)) in self.order().enumerate() {
            let pivot = a[r][c];
            let large = |(i, j): (usize, usize)| a[i][j].abs() <= MOST * pivot.abs();
            let left = || self.order().skip(place);
            if !left().all(|(i, _)| left().all(|(_, j)| large((i, j)))) {
                return false;
            }
            let row = a[r];
            for (i, _) in left().skip(1) {
                let factor = a[i][c] / pivot;
                a[i].iter_mut().zip(&row).for_each(|(x, y)| *x -= factor * y);
            }
        }
        true
    }

    /// Rows with their columns, in the order of the elimination.
    pub fn order(&self) -> impl Iterator<Item = (usize, usize)> {
        self.order[..usize::from(self.count)].iter().map(|&(r, c)| (usize::from(r), usize::from(c)))
    }

    /// The coordinates whose rates are free.
    pub fn free(&self, n: usize) -> impl Iterator<Item = usize> {
        (0..n).filter(|&i| self.order().all(|(_, c)| c != i))
    }

    /// The velocities that these rows admit, one for each free rate: with that rate one, and the other free rates zero.
    ///
    /// `n` is the number of coordinates, the first of the `N` places.
    #[must_use]
    pub fn basis<S: Scalar, const N: usize, const M: usize>(&self, n: usize, mut a: [[S; N]; M]) -> [[S; N]; N] {
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
