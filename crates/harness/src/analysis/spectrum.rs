use nalgebra::{DMatrix, Schur};

/// Rounding of the entries of a matrix, relative to its norm. A double eigenvalue without two eigenvectors moves by its root.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
const MAX_ITERATIONS: usize = 10_000;

/// The eigenvalues of a matrix.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spectrum {
    /// Real and imaginary parts.
    pub(super) values: Vec<[f64; 2]>,
    norm: f64,
}

/// The eigenvalues of a matrix, the largest by `order` first; `None` if the matrix is not finite.
pub(super) fn spectrum(matrix: &DMatrix<f64>, order: fn([f64; 2]) -> f64) -> Option<Spectrum> {
    if matrix.iter().any(|x| !x.is_finite()) {
        return None;
    }
    if matrix.is_empty() {
        return Some(Spectrum { values: Vec::new(), norm: 0.0 });
    }
    let schur = Schur::try_new(matrix.clone(), f64::EPSILON, MAX_ITERATIONS)?;
    let values = schur.complex_eigenvalues().iter().map(|z| [z.re, z.im]).collect();
    let mut spectrum = Spectrum { values, norm: matrix.norm() };
    spectrum.sort(order);
    Some(spectrum)
}

impl Spectrum {
    /// The spectrum with further eigenvalues, sorted by `order`.
    pub(super) fn with(mut self, more: &[[f64; 2]], order: fn([f64; 2]) -> f64) -> Self {
        self.values.extend(more);
        self.sort(order);
        self
    }

    fn sort(&mut self, order: fn([f64; 2]) -> f64) {
        self.values.sort_by(|a, b| order(*b).total_cmp(&order(*a)).then(b[1].total_cmp(&a[1])));
    }

    /// Whether no eigenvalue of a flow has a positive real part, but for rounding.
    pub(super) fn is_stable_flow(&self) -> bool {
        self.values.iter().all(|[re, _]| *re <= ROUNDING.sqrt() * self.norm)
    }

    /// Whether no eigenvalue of a map lies outside of the unit circle, but for rounding.
    pub(super) fn is_stable_map(&self) -> bool {
        let rounding = (ROUNDING * self.norm.max(1.0)).sqrt();
        self.values.iter().all(|z| size(*z) <= 1.0 + rounding)
    }
}

pub(super) fn size([re, im]: [f64; 2]) -> f64 {
    re.hypot(im)
}
