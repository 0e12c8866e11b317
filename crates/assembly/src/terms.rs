use crate::Assembly;
use crate::contributions::gathered;
use crate::local::WIDEST;

/// Adds the sums of the sizes of the terms of the equations of a step of length `h`, at the configuration and velocity `q` and `v`, one for
/// each coordinate and then one for each constraint: what their rounding is a part of. See
/// [`Convergence`](dla::convergence::Convergence).
pub(crate) fn add(
    assembly: &Assembly,
    time: (f64, f64),
    q: impl Fn(usize) -> f64,
    v: impl Fn(usize) -> f64,
    sizes: &mut [f64],
) {
    let coordinates = assembly.coordinates();
    for placed in assembly.placed() {
        let (mut momentum, mut level) = ([0.0; WIDEST], [0.0; WIDEST]);
        let (n, m) = (placed.at.len(), placed.rows.min(WIDEST));
        gathered(placed, &q, |q| {
            gathered(placed, &v, |v| placed.element.sizes(time, q, v, &mut momentum[..n], &mut level[..m]));
        });
        for (i, size) in placed.at.iter().zip(&momentum[..n]) {
            sizes[*i] += size;
        }
        for (to, size) in sizes[coordinates + placed.row..].iter_mut().zip(&level[..m]) {
            *to += size;
        }
    }
}
