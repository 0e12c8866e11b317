use super::equilibria::EquilibriumError;
use super::flow::admissible;
use dla::{Mechanism, Size};
use lagrangian::ReducedError;
use nalgebra::DMatrix;

/// A derivative below this, relative to the largest, is round-off.
const CYCLIC: f64 = 1e-10;

/// The coordinates of the first `n` that the reduced equations of the first `free` quasi-velocities depend on, and those whose rates these
/// depend on by them: what vanishes at all of some places in general position is taken to vanish.
pub(super) fn shape(
    system: &dyn Mechanism,
    (n, free): (usize, usize),
    places: impl Iterator<Item = (f64, Vec<f64>, Vec<f64>)>,
) -> Result<Vec<usize>, EquilibriumError> {
    let Size { n: all, m } = system.size();
    let time = 2 * all - m;
    let mut sizes = DMatrix::zeros(time, time + 1);
    let mut refused = None;
    let mut seen = false;
    for (t, q, xi) in places {
        match system.reduced_field(t, &q, &admissible(xi, free)) {
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
    let mut rows: Vec<usize> = (all..all + free).collect();
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
