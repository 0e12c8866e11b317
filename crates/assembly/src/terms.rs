use crate::Assembly;
use crate::assembly::PlacedElement;
use crate::contributions::gathered;
use crate::local::WIDEST;

/// The sums of the sizes of the terms that an element adds to the equations of a step of length `h`, at the configuration and
/// velocity `q` and `v`: what their rounding is a part of. See [`Convergence`](dla::convergence::Convergence).
pub(crate) fn for_each(
    assembly: &Assembly,
    (t, h): (f64, f64),
    q: impl Fn(usize) -> f64,
    v: impl Fn(usize) -> f64,
    mut then: impl FnMut(usize, &PlacedElement, &[f64], &[f64]),
) {
    for (k, placed) in assembly.placed().iter().enumerate() {
        let (mut momentum, mut level) = ([0.0; WIDEST], [0.0; WIDEST]);
        let (n, m) = (placed.at.len(), placed.rows.min(WIDEST));
        gathered(placed, &q, |q| {
            gathered(placed, &v, |v| placed.element.sizes((t, h), q, v, &mut momentum[..n], &mut level[..m]));
        });
        then(k, placed, &momentum[..n], &level[..m]);
    }
}

/// The same for equations of which there is one for each coordinate and one for each constraint, in their order.
pub(crate) fn add(
    assembly: &Assembly,
    time: (f64, f64),
    q: impl Fn(usize) -> f64,
    v: impl Fn(usize) -> f64,
    sizes: &mut [f64],
) {
    let coordinates = assembly.coordinates();
    for_each(assembly, time, q, v, |_, placed, momentum, level| {
        for (i, size) in placed.at.iter().zip(momentum) {
            sizes[*i] += size;
        }
        for (to, size) in sizes[coordinates + placed.row..].iter_mut().zip(level) {
            *to += size;
        }
    });
}
