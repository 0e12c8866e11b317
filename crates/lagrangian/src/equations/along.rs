//! The reduced equations of any system, by derivatives along its basis alone.

use crate::{AdmissibleBasis, Dual, HyperDual, Scalar, System, from_fn, mapped, velocity_of};

/// A pivot below this, relative to its entry, counts as none.
const DEGENERATE: f64 = 1e-13;

/// The accelerations `xi'` of the quasi-velocities by derivatives of the order `K = N - M`: none of a matrix of all coordinates. (Book, (1.5).)
///
/// `W' L_vv W xi' = W' (L_q + F - d/dt L_v at frozen xi)`: one evaluation of the Lagrangian with the mixed derivatives along the vectors of
/// the basis, and along these and the motion; one with the derivatives in the place along the vectors. The matrix is eliminated without
/// pivots: it is positive definite where the Lagrangian is a kinetic energy less a potential, and elsewhere the result may be no number.
///
/// Returns `None` if the system gives no basis, and for more than five quasi-velocities, for which the matrix of all coordinates is not
/// much larger.
#[inline(always)]
pub fn acceleration_along<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    xi: &[S; N],
) -> Option<[S; N]> {
    // A number of quasi-velocities is no argument that a type may be given.
    match const { N - M } {
        1 => along::<Sys, S, N, M, 1, 2>(system, t, q, xi),
        2 => along::<Sys, S, N, M, 2, 3>(system, t, q, xi),
        3 => along::<Sys, S, N, M, 3, 4>(system, t, q, xi),
        4 => along::<Sys, S, N, M, 4, 5>(system, t, q, xi),
        5 => along::<Sys, S, N, M, 5, 6>(system, t, q, xi),
        _ => None,
    }
}

#[inline(always)]
fn along<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize, const K: usize, const E: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    xi: &[S; N],
) -> Option<[S; N]> {
    let (zero, one) = (S::zero(), S::constant(1.0));
    let basis: AdmissibleBasis<S, N, M> = system.admissible_basis(t, q)?;
    let w = basis.vectors();
    let v = velocity_of(system, t, q, xi).ok()?;
    // The rate of the velocity at frozen xi.
    let moving: [Dual<S, 1>; N] = from_fn(
        #[inline(always)]
        |i| Dual { re: q[i], eps: [v[i]] },
    );
    let turning = velocity_of(system, Dual { re: t, eps: [one] }, &moving, &mapped(xi, Dual::fixed)).ok()?;
    // Along the vectors of the basis, and along these and, behind them, the motion at frozen xi.
    let last = |b: usize, x: S| if b == K { x } else { zero };
    let time = HyperDual { re: t, e1: [zero; K], e2: from_fn(|b| last(b, one)), e12: [[zero; E]; K] };
    let place: [HyperDual<S, K, E>; N] = from_fn(
        #[inline(always)]
        |i| HyperDual::linear(q[i], [zero; K], from_fn(|b| last(b, v[i]))),
    );
    let velocity: [HyperDual<S, K, E>; N] = from_fn(
        #[inline(always)]
        |i| {
            let both = from_fn(|b| if b == K { turning[i].eps[0] } else { w[b][i] });
            HyperDual::linear(v[i], from_fn(|a| w[a][i]), both)
        },
    );
    let second = system.lagrangian(time, &place, &velocity).e12;
    let place: [Dual<S, K>; N] = from_fn(
        #[inline(always)]
        |i| Dual { re: q[i], eps: from_fn(|a| w[a][i]) },
    );
    let slopes = system.lagrangian(Dual::fixed(t), &place, &mapped(&v, Dual::fixed)).eps;
    let force = system.force(t, q, &v);
    let mut right: [S; K] = from_fn(|a| slopes[a] - second[a][K]);
    if let Some(force) = force {
        for a in 0..K {
            for i in 0..N {
                right[a] += w[a][i] * force[i];
            }
        }
    }
    // L D L'.
    let mut matrix: [[S; K]; K] = from_fn(|a| from_fn(|b| second[a][b]));
    for k in 0..K {
        let pivot = matrix[k][k];
        // What is left of a degenerate matrix is the rounding of its entries: no number.
        let left = pivot.abs() - second[k][k].abs() * DEGENERATE;
        let pivot = left.where_positive(pivot, S::constant(f64::NAN)).recip();
        for i in k + 1..K {
            let factor = matrix[i][k] * pivot;
            for j in k + 1..K {
                let change = factor * matrix[k][j];
                matrix[i][j] -= change;
            }
            let change = factor * right[k];
            right[i] -= change;
        }
        matrix[k][k] = pivot;
    }
    for k in (0..K).rev() {
        for j in k + 1..K {
            let change = matrix[k][j] * right[j];
            right[k] -= change;
        }
        right[k] = right[k] * matrix[k][k];
    }
    Some(from_fn(|i| if i < K { right[i] } else { zero }))
}
