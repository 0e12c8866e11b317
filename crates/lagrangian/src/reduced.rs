use crate::linear::{Lu, Singular};
use crate::{AdmissibleBasis, Dual, Motion, MotionError, System};
use std::array::from_fn;

/// The quasi-velocities `xi` of a velocity in a basis of the admissible ones: `v = xi_1 w_1 + .. + A' eta`.
///
/// The first `N - M` places are the quasi-velocities; the last `M` are `eta`, the part across the distribution, zero
/// for an admissible velocity.
///
/// # Errors
/// [`Singular`] where basis and constraint do not span all velocities.
#[inline]
pub fn quasi_velocities<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    basis: &AdmissibleBasis<f64, N, M>,
) -> Result<[f64; N], Singular> {
    let (a, _) = system.constraint(t, q);
    let columns = basis.vectors().iter().chain(&a);
    let mut matrix = [[0.0; N]; N];
    for (j, column) in columns.enumerate() {
        for i in 0..N {
            matrix[i][j] = column[i];
        }
    }
    Ok(Lu::new(matrix)?.solve(*v))
}

/// The accelerations `xi'` in the system's basis `W(q, t)` of admissible velocities, for `b = 0`.
///
/// With `v = W xi` they follow from those of the full coordinates by `v' = W xi' + W' xi`.
///
/// # Errors
/// [`MotionError`] where the equations of motion, or the basis, are degenerate, or no basis is given.
pub fn reduced_acceleration<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Result<[f64; N], MotionError> {
    let degenerate = |source| MotionError { time: t, source };
    let none = Singular { column: 0, pivot: 0.0 };
    let basis = system.admissible_basis(t, q).ok_or(degenerate(none))?;
    let v = basis.combine(xi);
    let Motion { acceleration, .. } = system.motion(t, q, &v)?;

    let along: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [v[i]] });
    let moving = system.admissible_basis(Dual { re: t, eps: [1.0] }, &along).ok_or(degenerate(none))?;
    let turning = moving.combine(&xi.map(Dual::fixed));
    let rest = from_fn(|i| acceleration[i] - turning[i].eps[0]);
    quasi_velocities(system, t, q, &rest, &basis).map_err(degenerate)
}
