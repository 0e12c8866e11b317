use nalgebra::{DMatrix, Schur};

/// A real part, or a size beyond one, below this is rounding, relative to the largest eigenvalue or to one.
const ROUNDING: f64 = 1e-9;
const MAX_ITERATIONS: usize = 10_000;

/// The eigenvalues of a matrix, real and imaginary parts, the largest by `order` first; none where it is not finite.
pub(super) fn spectrum(matrix: &DMatrix<f64>, order: fn([f64; 2]) -> f64) -> Option<Vec<[f64; 2]>> {
    if matrix.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let schur = Schur::try_new(matrix.clone(), f64::EPSILON, MAX_ITERATIONS)?;
    let mut values: Vec<[f64; 2]> = schur.complex_eigenvalues().iter().map(|z| [z.re, z.im]).collect();
    values.sort_by(|a, b| order(*b).total_cmp(&order(*a)).then(b[1].total_cmp(&a[1])));
    Some(values)
}

/// Whether no eigenvalue has a positive real part.
pub(super) fn is_stable_flow(values: &[[f64; 2]]) -> bool {
    let largest = values.iter().map(|z| size(*z)).fold(0.0, f64::max);
    values.iter().all(|[re, _]| *re <= ROUNDING * largest)
}

/// Whether no eigenvalue lies outside of the unit circle.
pub(super) fn is_stable_map(values: &[[f64; 2]]) -> bool {
    values.iter().all(|z| size(*z) <= 1.0 + ROUNDING)
}

pub(super) fn size([re, im]: [f64; 2]) -> f64 {
    re.hypot(im)
}
