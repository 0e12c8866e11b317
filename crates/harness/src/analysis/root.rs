use nalgebra::{DMatrix, DVector, SVD};

/// A function with its derivative; `None` at a point without one. There may be fewer values than variables, or more.
pub(super) type Differentiated<'a> = dyn FnMut(&DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> + 'a;

/// Corrections below this, relative to the point, are rounding.
const ROUNDING: f64 = 1e-15;
/// If the correction at a point is below this, relative to the point, the point is a root but for rounding.
const SETTLED: f64 = 1e-13;
/// Singular values below this, relative to the largest, count as zero: the function does not change along their directions.
const NONE: f64 = 1e-12;
const MAX_ITERATIONS: u32 = 100;
/// Number of corrections in a row that do not help, after which none will.
const MAX_FAILURES: u32 = 16;
/// Damping at the first value, relative to the largest square of a singular value; and the factor by which it shrinks or grows.
const DAMPING: f64 = 1e-3;
const PACE: f64 = 8.0;

/// The root of `F` near `z`, which need not be isolated: a near one of a family of roots.
///
/// Levenberg and Marquardt's method with a damping that goes to zero with `|F|`, which converges quadratically also to families (Fan and
/// Yuan 2005, Computing 74, 23-39). Each correction is the shortest of all that do as well: it comes from the singular values of the
/// derivative, and along the directions of a family it is zero. The method succeeds if `F` is below `tolerance`, in its own units, or if
/// the rest of `F` is rounding.
pub(super) fn nearest_root(f: &mut Differentiated<'_>, start: DVector<f64>, tolerance: f64) -> Option<DVector<f64>> {
    let mut z = start;
    let (mut value, slope) = f(&z)?;
    let mut slope = Decomposed::of(slope)?;
    let (first, mut damping, mut failures) = (value.norm(), DAMPING, 0);
    for _ in 0..MAX_ITERATIONS {
        let size = value.norm();
        if size == 0.0 {
            break;
        }
        let step = slope.correction(&value, damping * size / first);
        let next = &z + &step;
        match f(&next) {
            Some((there, its_slope)) if there.norm() < size => {
                (z, value, slope) = (next, there, Decomposed::of(its_slope)?);
                (damping, failures) = (damping / PACE, 0);
            }
            _ if size <= tolerance || failures == MAX_FAILURES => break,
            _ if step.norm() <= ROUNDING * (1.0 + z.norm()) => break,
            _ => (damping, failures) = (damping * PACE, failures + 1),
        }
    }
    let rounding = SETTLED * (1.0 + z.norm());
    let is_rounding = || slope.correction(&value, 0.0).norm() <= rounding && value.norm() <= rounding * slope.largest();
    (value.norm() <= tolerance || is_rounding()).then_some(z)
}

/// A derivative by its singular values.
struct Decomposed {
    left: DMatrix<f64>,
    sizes: DVector<f64>,
    right: DMatrix<f64>,
}

impl Decomposed {
    fn of(slope: DMatrix<f64>) -> Option<Self> {
        if slope.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let svd = SVD::try_new(slope, true, true, f64::EPSILON, 10_000)?;
        Some(Self { left: svd.u?, sizes: svd.singular_values, right: svd.v_t? })
    }

    fn largest(&self) -> f64 {
        self.sizes.max()
    }

    /// The shortest correction that takes the value to zero, as nearly as `damping` (a fraction of the largest square) allows.
    fn correction(&self, value: &DVector<f64>, damping: f64) -> DVector<f64> {
        let largest = self.largest();
        let mut parts = self.left.tr_mul(value);
        for (part, size) in parts.iter_mut().zip(&self.sizes) {
            let factor = size / (size * size + damping * largest * largest);
            *part *= if *size > NONE * largest { -factor } else { 0.0 };
        }
        self.right.tr_mul(&parts)
    }
}
