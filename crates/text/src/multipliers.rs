use crate::slices::{SlicedMotion, TextSlices};
use lagrangian::{Dual, Seeded};
use nalgebra::linalg::FullPivLU;
use nalgebra::{DMatrix, DVector, Dyn, SVD};

/// The matrix of the equations for accelerations and multipliers, ready for right sides.
///
/// Coordinates are measured by their inertia, and rows by the accelerations that they ask for, so that neither light coordinates nor rows in
/// other units count as round-off.
struct Factored {
    sizes: DVector<f64>,
    factors: Factors,
}

enum Factors {
    Regular(FullPivLU<f64, Dyn, Dyn>),
    /// Rows that depend on one another: the shortest multipliers are taken.
    Singular(SVD<f64, Dyn, Dyn>),
}

/// A pivot below it, relative to the largest, is round-off.
const SINGULAR: f64 = 1e-12;

impl Factored {
    fn new(block: &DMatrix<f64>, rows: &DMatrix<f64>) -> Self {
        let (n, m) = (block.nrows(), rows.nrows());
        let mut sizes = DVector::from_element(n + m, 1.0);
        for i in 0..n {
            let mass = block[(i, i)].abs();
            if mass > 0.0 {
                sizes[i] = mass.sqrt().recip();
            }
        }
        for k in 0..m {
            let length = (0..n).map(|i| (rows[(k, i)] * sizes[i]).powi(2)).sum::<f64>().sqrt();
            if length > 0.0 {
                sizes[n + k] = length.recip();
            }
        }
        let matrix = DMatrix::from_fn(n + m, n + m, |i, j| {
            let entry = match (i < n, j < n) {
                (true, true) => block[(i, j)],
                (true, false) => -rows[(j - n, i)],
                (false, true) => rows[(i - n, j)],
                (false, false) => 0.0,
            };
            entry * sizes[i] * sizes[j]
        });
        let regular = matrix.clone().full_piv_lu();
        let pivots = regular.lu_internal().diagonal().abs();
        let factors = if pivots.min() > SINGULAR * pivots.max() {
            Factors::Regular(regular)
        } else {
            Factors::Singular(matrix.svd(true, true))
        };
        Self { sizes, factors }
    }

    fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        let scaled = right.component_mul(&self.sizes);
        let solution = match &self.factors {
            Factors::Regular(factors) => factors.solve(&scaled),
            Factors::Singular(factors) => factors.solve(&scaled, SINGULAR).ok(),
        };
        solution.map(|solution| solution.component_mul(&self.sizes))
    }
}

impl SlicedMotion<f64> {
    fn factored(&self) -> Factored {
        let (n, m) = (self.right.len(), self.level.len());
        Factored::new(&DMatrix::from_row_slice(n, n, &self.block), &DMatrix::from_row_slice(m, n, &self.rows))
    }
}

/// The multipliers of the constraints at a state, so that `A' lambda` are their forces; NaN where they are not finite.
pub(crate) fn multipliers(of: TextSlices<'_, f64>, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
    let motion = of.motion(t, q, v);
    let right = DVector::from_iterator(q.len() + of.m(), motion.right.iter().chain(&motion.level).copied());
    let finite = motion.block.iter().chain(&motion.rows).chain(&right).all(|x| x.is_finite());
    let solution = if finite { motion.factored().solve(&right) } else { None };
    solution.map_or_else(|| vec![f64::NAN; of.m()], |x| x.as_slice()[q.len()..].to_vec())
}

/// The multipliers with their derivatives: where `K x = r`, `K x' = r' - K' x`.
pub(crate) fn multipliers_along(of: TextSlices<'_, Seeded>, t: Seeded, q: &[Seeded], v: &[Seeded]) -> Vec<Seeded> {
    let (n, m, motion) = (q.len(), of.m(), of.motion(t, q, v));
    let values = |x: &[Seeded]| -> Vec<f64> { x.iter().map(|x| x.re).collect() };
    let at = SlicedMotion {
        block: values(&motion.block),
        rows: values(&motion.rows),
        right: values(&motion.right),
        level: values(&motion.level),
    };
    let lost = || vec![Dual::fixed(f64::NAN); m];
    if !at.block.iter().chain(&at.rows).chain(&at.right).chain(&at.level).all(|x| x.is_finite()) {
        return lost();
    }
    let factored = at.factored();
    let Some(x) = factored.solve(&DVector::from_iterator(n + m, at.right.iter().chain(&at.level).copied())) else {
        return lost();
    };
    // The right sides less the products with the solution.
    let rest_of_row = |i: usize| {
        let free = (0..n).fold(motion.right[i], |rest, j| rest - motion.block[i * n + j] * x[j]);
        (0..m).fold(free, |rest, k| rest + motion.rows[k * n + i] * x[n + k])
    };
    let level = |k: usize| (0..n).fold(motion.level[k], |rest, i| rest - motion.rows[k * n + i] * x[i]);
    let rest: Vec<Seeded> = (0..n).map(rest_of_row).chain((0..m).map(level)).collect();
    let mut multipliers: Vec<Seeded> = (0..m).map(|k| Dual::fixed(x[n + k])).collect();
    for direction in 0..rest.first().map_or(0, |rest| rest.eps.len()) {
        let right = DVector::from_iterator(n + m, rest.iter().map(|rest| rest.eps[direction]));
        let Some(slope) = factored.solve(&right) else { return lost() };
        for (k, multiplier) in multipliers.iter_mut().enumerate() {
            multiplier.eps[direction] = slope[n + k];
        }
    }
    multipliers
}
