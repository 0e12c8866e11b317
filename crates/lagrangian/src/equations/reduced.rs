use crate::linear::{Lu, Singular};
use crate::{
    AdmissibleBasis, Dual, Motion, MotionError, Reduced as _, Scalar, System, acceleration_along, from_fn, mapped,
};
use thiserror::Error;

/// Why there are no reduced equations.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ReducedError {
    /// The system gives no basis of its admissible velocities.
    #[error(
        "the reduced equations need a basis of the admissible velocities, and the system has no basis; `WithBasis` derives one"
    )]
    NoBasis,
    /// The equations of motion, the basis or the constraint are degenerate.
    #[error(transparent)]
    Motion(#[from] MotionError),
}

/// The reduced equations at one point: `q' = W xi + v_b`, and `xi'`.
///
/// `W` is the system's basis of admissible velocities, `v_b = -A' (A A')^-1 b` the shortest velocity that meets an affine
/// constraint. Only the first `N - M` places of `xi` and `xi'` count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReducedSlope<const N: usize> {
    /// The velocity.
    pub velocity: [f64; N],
    /// The accelerations of the quasi-velocities.
    pub acceleration: [f64; N],
}

/// The velocity of the quasi-velocities `xi`.
///
/// # Errors
/// [`ReducedError`] where the system gives no basis, or its constraints depend on one another.
#[inline(always)]
pub fn velocity_of<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    xi: &[S; N],
) -> Result<[S; N], ReducedError> {
    system.reduced().velocity(
        t,
        q,
        xi,
        #[inline(always)]
        || {
            let basis = system.admissible_basis(t, q).ok_or(ReducedError::NoBasis)?;
            let v = basis.combine(xi);
            Ok(match shift(system, t, q) {
                Some(shift) => S::array(
                    #[inline(always)]
                    |i| v[i] + shift[i],
                ),
                None => v,
            })
        },
    )
}

/// The quasi-velocities `xi` of a velocity: `v = W xi + v_b`, with what lies across the distribution left out.
///
/// # Errors
/// [`ReducedError`] where there is no basis, or basis and constraint do not span all velocities.
#[inline]
pub fn quasi_velocities<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<[f64; N], ReducedError> {
    let basis = system.admissible_basis(t, q).ok_or(ReducedError::NoBasis)?;
    let v = match shift(system, t, q) {
        Some(shift) => from_fn(|i| v[i] - shift[i]),
        None => *v,
    };
    split(system, t, q, &v, &basis)
}

/// The reduced equations of motion, by hand where the system gives them, else by derivatives along its basis, or from its motion in full
/// coordinates: `v' = W xi' + (W' xi + v_b')`.
///
/// # Errors
/// [`ReducedError`] where there is no basis, or where equations are degenerate.
#[inline]
pub fn reduced_slope<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Result<ReducedSlope<N>, ReducedError> {
    let velocity = velocity_of(system, t, q, xi)?;
    let acceleration = match system.reduced().reduced_motion(t, q, xi) {
        Some(acceleration) if acceleration[..N - M].iter().all(|x| x.is_finite()) => acceleration,
        // Of equations that are degenerate these tell where.
        _ => derived_acceleration(system, t, q, xi)?,
    };
    Ok(ReducedSlope { velocity, acceleration })
}

/// The accelerations `xi'` of a system that does not know them by hand: by derivatives [along its basis](acceleration_along), and what
/// these cannot do from the motion in full coordinates.
///
/// # Errors
/// As [`reduced_acceleration`].
#[inline(never)]
pub fn derived_acceleration<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Result<[f64; N], ReducedError> {
    match acceleration_along(system, t, q, xi) {
        Some(acceleration) if acceleration.iter().all(|x| x.is_finite()) => Ok(acceleration),
        _ => reduced_acceleration(system, t, q, xi),
    }
}

/// The accelerations `xi'` from the motion in full coordinates.
///
/// # Errors
/// [`ReducedError`] where there is no basis, or where equations are degenerate.
pub fn reduced_acceleration<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Result<[f64; N], ReducedError> {
    let v = velocity_of(system, t, q, xi)?;
    let Motion { acceleration, .. } = Motion::of(system, t, q, &v)?;
    reduced_from_motion(system, t, q, xi, (&v, &acceleration))
}

/// The accelerations `xi'` if `v` is the velocity of the quasi-velocities and `acceleration` its rate.
///
/// # Errors
/// [`ReducedError`] if there is no basis, or if the basis is degenerate.
pub fn reduced_from_motion<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
    (v, acceleration): (&[f64; N], &[f64; N]),
) -> Result<[f64; N], ReducedError> {
    let basis = system.admissible_basis(t, q).ok_or(ReducedError::NoBasis)?;
    let along: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [v[i]] });
    let turning = velocity_of(system, Dual { re: t, eps: [1.0] }, &along, &mapped(xi, Dual::fixed))?;
    let rest = from_fn(|i| acceleration[i] - turning[i].eps[0]);
    split(system, t, q, &rest, &basis)
}

/// The part of a vector along the basis, the rest being a combination of the rows of `A`: `x = W xi + A' eta`.
fn split<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    x: &[f64; N],
    basis: &AdmissibleBasis<f64, N, M>,
) -> Result<[f64; N], ReducedError> {
    let (a, _) = system.constraint(t, q);
    let mut matrix = [[0.0; N]; N];
    for (j, column) in basis.vectors().iter().chain(&a).enumerate() {
        for i in 0..N {
            matrix[i][j] = column[i];
        }
    }
    let degenerate = |source: Singular| MotionError { time: t, source };
    let mut xi = Lu::new(matrix).map_err(degenerate)?.solve(*x);
    xi[N - M..].fill(0.0);
    Ok(xi)
}

/// `v_b` of a system at one point.
#[inline(always)]
fn shift<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
) -> Option<[S; N]> {
    let (a, b) = system.constraint(t, q);
    shortest(&a, &b)
}

/// `v_b = -A' (A A')^-1 b`; none where `b` and its derivatives vanish, so that a linear constraint pays nothing.
///
/// The symmetric matrix is eliminated without pivots, on any scalar; dependent rows of `A` have been refused by the
/// equations of motion.
#[inline(always)]
pub(crate) fn shortest<S: Scalar, const N: usize, const M: usize>(a: &[[S; N]; M], b: &[S; M]) -> Option<[S; N]> {
    let mut moves = false;
    for b in b {
        moves |= !b.is_zero();
    }
    if !moves {
        return None;
    }
    let mut gram: [[S; M]; M] = from_fn(|k| from_fn(|l| (0..N).fold(S::zero(), |sum, i| sum + a[k][i] * a[l][i])));
    let mut eta = mapped(b, |b| -b);
    for k in 0..M {
        for l in k + 1..M {
            let factor = gram[l][k] / gram[k][k];
            for m in k..M {
                gram[l][m] -= factor * gram[k][m];
            }
            eta[l] -= factor * eta[k];
        }
    }
    for k in (0..M).rev() {
        for l in k + 1..M {
            eta[k] -= gram[k][l] * eta[l];
        }
        eta[k] = eta[k] / gram[k][k];
    }
    Some(from_fn(|i| (0..M).fold(S::zero(), |sum, k| sum + a[k][i] * eta[k])))
}
