use super::manifold::{DEPENDENT, Split};
use super::spectrum::{Spectrum, spectrum};
use nalgebra::DMatrix;

/// The directions along which a motion may be displaced: changes of the shape that keep the constraints on positions, with the remaining
/// coordinates following, and changes of the quasi-velocities.
pub(super) struct AllowedDirections {
    /// In the coordinates of the shape and the quasi-velocities, orthonormal.
    along: DMatrix<f64>,
    /// The same directions in all coordinates and the quasi-velocities.
    whole: DMatrix<f64>,
    /// The remaining coordinates that the constraints on positions determine by the shape.
    pub(super) determined: Vec<usize>,
}

impl AllowedDirections {
    /// The directions of the coordinates `shape`, with the remaining coordinates following, and of `free` quasi-velocities; `rows` are the
    /// gradients of the constraints on positions in all coordinates.
    pub(super) fn new(rows: &DMatrix<f64>, shape: &[usize], free: usize) -> Option<Self> {
        let (n, count) = (rows.ncols(), shape.len());
        let others: Vec<usize> = (0..n).filter(|i| !shape.contains(i)).collect();
        let (of_others, of_shape) = (rows.select_columns(&others), rows.select_columns(shape));
        let open = Split::by(&of_others, DEPENDENT)?.kernel;
        // The combinations of constraints that the remaining coordinates cannot make up for.
        let left = Split::by(&of_others.transpose(), DEPENDENT)?.kernel;
        let kept = Split::by(&(left.transpose() * &of_shape), DEPENDENT)?.kernel;
        let k = kept.ncols();
        let mut along = DMatrix::zeros(count + free, k + free);
        along.view_mut((0, 0), (count, k)).copy_from(&kept);
        along.view_mut((count, k), (free, free)).fill_with_identity();
        let mut whole = DMatrix::zeros(n + free, k + free);
        whole.view_mut((n, k), (free, free)).fill_with_identity();
        shape.iter().enumerate().for_each(|(i, &q)| whole.view_mut((q, 0), (1, k)).copy_from(&kept.row(i)));
        if !others.is_empty() && rows.nrows() > 0 {
            let follow = -(of_others.pseudo_inverse(DEPENDENT).ok()? * of_shape * &kept);
            others.iter().enumerate().for_each(|(i, &q)| whole.view_mut((q, 0), (1, k)).copy_from(&follow.row(i)));
        }
        let is_determined = |(i, _): &(usize, &usize)| open.row(*i).norm() <= DEPENDENT;
        let determined = others.iter().enumerate().filter(is_determined).map(|(_, &q)| q).collect();
        Some(Self { along, whole, determined })
    }

    /// Restricts a matrix to these directions. Its rows belong to shape and quasi-velocities, its columns to all coordinates and the
    /// quasi-velocities.
    pub(super) fn restrict(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        self.along.tr_mul(matrix) * &self.whole
    }
}

/// The number of directions that `matrix` takes to zero at once, and the eigenvalues of `about + matrix`. Directions that the matrix takes
/// to zero, at once or in the end, have the eigenvalue `about`; the remaining eigenvalues are computed without these directions. So the
/// rates of a family of motions, which are often double eigenvalues with one vector, take no digits. A singular value up to `rounding`
/// counts as zero.
pub(super) fn with_family(
    matrix: DMatrix<f64>,
    about: f64,
    rounding: f64,
    order: fn([f64; 2]) -> f64,
) -> Option<(usize, Spectrum)> {
    if matrix.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let (norm, count) = (matrix.norm(), matrix.ncols());
    let (mut rest, mut family) = (matrix, None);
    loop {
        let Split { row_space, kernel } = Split::by(&rest, rounding.max(NEGLIGIBLE * norm))?;
        family = family.or(Some(kernel.ncols()));
        if kernel.ncols() == 0 {
            break;
        }
        rest = row_space.tr_mul(&rest) * &row_space;
    }
    let neutral = count - rest.ncols();
    let rest = &rest + DMatrix::identity(rest.ncols(), rest.ncols()) * about;
    Some((family.unwrap_or(0), spectrum(&rest, order)?.with(&vec![[about, 0.0]; neutral], order)))
}

/// A direction with a singular value below this, relative to the norm of the matrix, counts as taken to zero.
const NEGLIGIBLE: f64 = 1e-10;
