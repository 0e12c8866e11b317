use super::equilibria::EquilibriumError;
use super::reduced_field;
use dla::SeededMechanics;
use lagrangian::{ReducedError, from_fn};
use nalgebra::DMatrix;

/// A derivative below this, relative to the largest, is round-off.
const CYCLIC: f64 = 1e-10;

/// The coordinates of the first `n` that the reduced equations of the first `free` quasi-velocities depend on, and those whose rates these
/// depend on by them: what vanishes at all of some places in general position is taken to vanish.
pub(super) fn shape<const N: usize, const M: usize>(
    system: &dyn SeededMechanics<N, M>,
    (n, free): (usize, usize),
    places: impl Iterator<Item = (f64, [f64; N], [f64; N])>,
) -> Result<Vec<usize>, EquilibriumError> {
    let dimension = N - M;
    let time = N + dimension;
    let model = system.gradients();
    let mut sizes = DMatrix::zeros(N + dimension, N + dimension + 1);
    let mut refused = None;
    let mut seen = false;
    for (t, q, xi) in places {
        match reduced_field(&*model, t, &q, &from_fn(|a| if a < free { xi[a] } else { 0.0 })) {
            Some(Ok(field)) if field.derivative.iter().all(|x| x.is_finite()) => {
                let sum = &sizes + field.derivative.abs();
                (sizes, seen) = (sum, true);
            }
            // A formula may have no value there.
            Some(Ok(_)) => {}
            Some(Err(singular)) => refused = refused.or(Some(EquilibriumError::Singular(singular))),
            None => return Err(ReducedError::NoBasis.into()),
        }
    }
    if !seen {
        return Err(refused.unwrap_or(EquilibriumError::NotFinite));
    }
    let largest = sizes.max();
    let matters = |row: usize, column: usize| sizes[(row, column)] > CYCLIC * largest;
    let mut shape: Vec<usize> = Vec::new();
    let mut rows: Vec<usize> = (N..N + free).collect();
    while let Some(next) = (0..n).find(|j| !shape.contains(j) && rows.iter().any(|row| matters(*row, *j))) {
        shape.push(next);
        rows.push(next);
    }
    if rows.iter().any(|row| matters(*row, time)) {
        return Err(EquilibriumError::TimeDependent);
    }
    shape.sort_unstable();
    Ok(shape)
}
