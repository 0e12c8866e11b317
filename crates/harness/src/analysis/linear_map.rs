use super::manifold::{DEPENDENT, Split};
use super::spectrum::{Spectrum, spectrum};
use nalgebra::DMatrix;

/// A linear map on the directions along which a motion may be displaced: those of some coordinates that keep the constraints on positions,
/// and those of its quasi-velocities.
pub(super) struct AllowedDirections(DMatrix<f64>);

impl AllowedDirections {
    /// Of the coordinates `shape`, the others being free to follow, and so many quasi-velocities; `rows` are the gradients of the constraints
    /// on positions in all coordinates.
    pub(super) fn new(rows: &DMatrix<f64>, shape: &[usize], free: usize) -> Option<Self> {
        let others: Vec<usize> = (0..rows.ncols()).filter(|i| !shape.contains(i)).collect();
        // What the other coordinates cannot make up for.
        let left = Split::by(&rows.select_columns(&others).transpose(), DEPENDENT)?.unseen;
        let along = Split::by(&(left.transpose() * rows.select_columns(shape)), DEPENDENT)?.unseen;
        let mut directions = DMatrix::zeros(shape.len() + free, along.ncols() + free);
        directions.view_mut((0, 0), along.shape()).copy_from(&along);
        directions.view_mut((shape.len(), along.ncols()), (free, free)).fill_with_identity();
        Some(Self(directions))
    }

    /// What a matrix in shape and quasi-velocities does along them.
    pub(super) fn restrict(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        self.0.tr_mul(matrix) * &self.0
    }
}

/// The eigenvalues of `about + matrix`, in two parts: those of directions that the matrix takes to zero, or in the end to zero, are `about`;
/// the others are those of what is left of the space without them. So the rates of a family of motions, which are often double eigenvalues
/// with one vector, take no digits. With them the number of directions that it takes to zero at once. A singular value up to `rounding` is
/// none.
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
        let Split { seen, unseen } = Split::by(&rest, rounding.max(UNSEEN * norm))?;
        family = family.or(Some(unseen.ncols()));
        if unseen.ncols() == 0 {
            break;
        }
        rest = seen.tr_mul(&rest) * &seen;
    }
    let neutral = count - rest.ncols();
    let rest = &rest + DMatrix::identity(rest.ncols(), rest.ncols()) * about;
    Some((family.unwrap_or(0), spectrum(&rest, order)?.with(&vec![[about, 0.0]; neutral], order)))
}

/// A singular value below this, relative to the norm of the matrix, is that of a direction which it takes to zero.
const UNSEEN: f64 = 1e-10;
