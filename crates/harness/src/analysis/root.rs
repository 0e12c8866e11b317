use nalgebra::{DMatrix, DVector};

/// A function with its derivative, at a point where it exists.
pub(super) type Differentiated<'a> = dyn FnMut(&DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> + 'a;

/// Corrections below this, relative to the point, are rounding.
const ROUNDING: f64 = 1e-15;
const MAX_ITERATIONS: u32 = 200;

/// The root of `F` near `z`, which need not be isolated: of a family of roots one close by.
///
/// Levenberg and Marquardt's method with the damping `|F|`, which converges quadratically also to families. (Fan and Yuan
/// 2005, Computing 74, 23-39.) `F` is small where it is below `tolerance`, in its own units.
pub(super) fn nearest_root(f: &mut Differentiated<'_>, start: DVector<f64>, tolerance: f64) -> Option<DVector<f64>> {
    let mut z = start;
    let (mut value, mut slope) = f(&z)?;
    let mut damping = 1.0;
    for _ in 0..MAX_ITERATIONS {
        let size = value.norm();
        if size == 0.0 {
            break;
        }
        let normal = slope.tr_mul(&slope) + DMatrix::identity(z.len(), z.len()) * (damping * size);
        let step = normal.cholesky()?.solve(&-slope.tr_mul(&value));
        let next = &z + &step;
        match f(&next) {
            Some((there, its_slope)) if there.norm() < size => {
                (z, value, slope) = (next, there, its_slope);
                damping = f64::max(damping / 4.0, 1e-6);
            }
            _ if step.norm() <= ROUNDING * (1.0 + z.norm()) => break,
            _ => damping *= 4.0,
        }
    }
    (value.norm() <= tolerance).then_some(z)
}
