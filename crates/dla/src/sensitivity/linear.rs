use lagrangian::linear::{Singular, largest};
use nalgebra::{DMatrix, DVector, Dyn, LU};

/// A factorised square matrix, its rows and columns scaled first: unknowns of a step have different units.
#[derive(Debug, Clone)]
pub(super) struct Scaled {
    lu: LU<f64, Dyn, Dyn>,
    rows: DVector<f64>,
    columns: DVector<f64>,
}

/// A pivot below it, relative to its row and column, is round-off.
const THRESHOLD: f64 = 4.0 * f64::EPSILON;

impl Scaled {
    /// # Errors
    /// [`Singular`] if a pivot vanishes to rounding or is not a number.
    pub(super) fn new(mut matrix: DMatrix<f64>) -> Result<Self, Singular> {
        let size = |column: Vec<f64>| largest(&column).recip();
        let rows =
            DVector::from_iterator(matrix.nrows(), matrix.row_iter().map(|row| size(row.iter().copied().collect())));
        for mut column in matrix.column_iter_mut() {
            column.component_mul_assign(&rows);
        }
        let columns = DVector::from_iterator(
            matrix.ncols(),
            matrix.column_iter().map(|column| size(column.iter().copied().collect())),
        );
        for (mut column, scale) in matrix.column_iter_mut().zip(&columns) {
            column *= *scale;
        }
        let lu = matrix.lu();
        for (column, pivot) in lu.u().diagonal().iter().enumerate() {
            if pivot.abs() <= THRESHOLD || !pivot.is_finite() {
                return Err(Singular { column, pivot: pivot.abs() });
            }
        }
        Ok(Self { lu, rows, columns })
    }

    /// The solutions `X` of `A X = B`.
    pub(super) fn solve(&self, mut right: DMatrix<f64>) -> DMatrix<f64> {
        for mut column in right.column_iter_mut() {
            column.component_mul_assign(&self.rows);
        }
        // Always there: the pivots have been checked.
        if !self.lu.solve_mut(&mut right) {
            right.fill(f64::NAN);
        }
        for mut column in right.column_iter_mut() {
            column.component_mul_assign(&self.columns);
        }
        right
    }

    /// The largest component of a vector of unknowns, in the units of their columns.
    pub(super) fn size(&self, x: impl IntoIterator<Item = f64>) -> f64 {
        let scaled: Vec<f64> = x.into_iter().zip(&self.columns).map(|(x, scale)| x / scale).collect();
        largest(&scaled)
    }
}
