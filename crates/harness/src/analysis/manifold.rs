use dla::Mechanism;
use nalgebra::{DMatrix, DVector, SVD};

/// A singular value of rows of the length one that is below this is none: rows that depend on one another.
pub(super) const DEPENDENT: f64 = 1e-10;

/// The row space of a matrix, and its kernel, each as orthonormal columns.
#[derive(Debug, Clone)]
pub(super) struct Split {
    pub(super) row_space: DMatrix<f64>,
    pub(super) kernel: DMatrix<f64>,
}

impl Split {
    /// Splits the space that the columns of `rows` number; a singular value up to `floor` counts as zero.
    pub(super) fn by(rows: &DMatrix<f64>, floor: f64) -> Option<Self> {
        let n = rows.ncols();
        if n == 0 {
            return Some(Self { row_space: DMatrix::zeros(0, 0), kernel: DMatrix::zeros(0, 0) });
        }
        // A square matrix has all right vectors.
        let square = rows.clone().resize(rows.nrows().max(n), n, 0.0);
        let svd = SVD::try_new(square, false, true, f64::EPSILON, 10_000)?;
        let (vectors, sizes) = (svd.v_t?, svd.singular_values);
        let of = |above: bool| -> Vec<DVector<f64>> {
            let chosen = (0..n).filter(|&k| (sizes[k] > floor) == above);
            chosen.map(|k| vectors.row(k).transpose()).collect()
        };
        let columns = |of: &[DVector<f64>]| DMatrix::from_fn(n, of.len(), |i, j| of[j][i]);
        Some(Self { row_space: columns(&of(true)), kernel: columns(&of(false)) })
    }
}

/// The functions of the constraints on positions, and the rows of their gradients, in the first `n` coordinates; no rows without such
/// constraints. The rows have the length one: in whichever unit a function is, it says the same.
pub(super) fn positions(system: &dyn Mechanism, n: usize, t: f64, q: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
    let misses = system.position_misses(t, q);
    let length = |eps: &[f64]| eps.iter().take(n).fold(0.0, |sum: f64, x| sum.hypot(*x));
    let lengths: Vec<f64> =
        misses.iter().map(|(_, eps)| Some(length(eps)).filter(|l| *l > 0.0).unwrap_or(1.0)).collect();
    let values = DVector::from_fn(misses.len(), |k, _| misses[k].0 / lengths[k]);
    let rows = DMatrix::from_fn(misses.len(), n, |k, i| misses[k].1[i] / lengths[k]);
    (values, rows)
}

/// A matrix with further rows below it, which have fewer columns.
pub(super) fn with_rows(matrix: DMatrix<f64>, rows: &DMatrix<f64>) -> DMatrix<f64> {
    let above = matrix.nrows();
    let mut whole = matrix.resize_vertically(above + rows.nrows(), 0.0);
    whole.view_mut((above, 0), rows.shape()).copy_from(rows);
    whole
}
