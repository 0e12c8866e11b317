use crate::{AT_ONCE, BLOCK, seed};
use crate::{Constraint, Dual, Scalar, SeldomNumber, System, from_fn, mapped};

/// The rows along which the constraints act on the system at a velocity: `A(q, t)`, and `d phi / dv` where a constraint is
/// not affine.
#[inline]
pub fn reaction_rows<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [[S; N]; M]
where
    Sys: System<N, M>,
    S: Scalar,
{
    let (mut a, _) = system.constraint(t, q);
    if let Some(phi) = system.nonlinear(Dual::fixed(t), &mapped(q, Dual::fixed), &Dual::variables(v)) {
        for k in 0..M {
            a[k] = phi[k].map_or(a[k], |phi: Dual<S, N>| phi.eps);
        }
    }
    a
}

/// The rows `A(q, t)` and their derivative along `(t', q')`.
#[inline]
pub fn rows_along<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    (t, in_t): (f64, f64),
    q: &[f64; N],
    in_q: &[f64; N],
) -> [[Dual<f64, 1>; N]; M] {
    let rows = system.constraint(SeldomNumber::moving(t, in_t), &from_fn(|i| SeldomNumber::moving(q[i], in_q[i]))).0;
    mapped(&rows, |row| mapped(&row, |a| Dual { re: a.value(), eps: [a.rate()] }))
}

/// The rows of the constraints on positions, `A_k = dg_k/dq` and `b_k = dg_k/dt`, from the functions of
/// [`System::holonomic`]; zero for the others.
///
/// [`System::constraint`] may call it and fill in its other rows.
#[inline]
pub fn position_rows<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N]) -> Constraint<S, N, M>
where
    Sys: System<N, M>,
    S: Scalar,
{
    let (mut a, mut b) = ([[S::zero(); N]; M], [S::zero(); M]);
    match const { N <= AT_ONCE } {
        true => add_gradients::<Sys, S, N, M, N>(system, t, q, 0, &mut a),
        false => {
            for from in (0..N).step_by(BLOCK) {
                add_gradients::<Sys, S, N, M, BLOCK>(system, t, q, from, &mut a);
            }
        }
    }
    if let Some(in_t) = system.holonomic(Dual { re: t, eps: [S::constant(1.0)] }, &mapped(q, Dual::fixed)) {
        for k in 0..M {
            b[k] = in_t[k].map_or(b[k], |g: Dual<S, 1>| g.eps[0]);
        }
    }
    (a, b)
}

/// The derivatives of the functions of positions in `P` coordinates, from number `from` on; nothing where there is none.
#[inline(always)]
fn add_gradients<Sys, S, const N: usize, const M: usize, const P: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    from: usize,
    a: &mut [[S; N]; M],
) where
    Sys: System<N, M>,
    S: Scalar,
{
    let one = S::constant(1.0);
    let in_q: [Dual<S, P>; N] = from_fn(|i| Dual { re: q[i], eps: seed(one, i, from) });
    let Some(g) = system.holonomic(Dual::fixed(t), &in_q) else { return };
    for k in 0..M {
        let Some(g) = g[k] else { continue };
        for (j, e) in (from..N).zip(g.eps) {
            a[k][j] = e;
        }
    }
}

/// The residuals `g_k` of the constraints on positions, and their gradients; `None` without such constraints.
///
/// A value that the rounding of the coordinates alone may bring, `2 eps sum_i |dg/dq_i q_i|`, counts as zero: far from the
/// origin no coordinates come nearer.
#[inline(always)]
pub fn position_misses<Sys, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
) -> Option<[Option<Dual<f64, N>>; M]>
where
    Sys: System<N, M>,
{
    let g: [Option<Dual<f64, N>>; M] = system.holonomic(Dual::fixed(t), &Dual::variables(q))?;
    Some(g.map(|g| g.map(|g| within_rounding(q, g))))
}

/// A value with its gradient in the coordinates `q`; zero if the rounding of the coordinates alone may bring it.
#[must_use]
#[inline(always)]
pub fn within_rounding<const N: usize>(q: &[f64; N], g: Dual<f64, N>) -> Dual<f64, N> {
    let rounding: f64 = (0..N).map(|i| (g.eps[i] * q[i]).abs()).sum();
    if g.re.abs() <= 2.0 * f64::EPSILON * rounding { Dual { re: 0.0, ..g } } else { g }
}

/// The largest `|g_k(q, t)|` of the constraints on positions; zero without such constraints.
#[inline]
pub fn position_residual<Sys, const N: usize, const M: usize>(system: &Sys, t: f64, q: &[f64; N]) -> f64
where
    Sys: System<N, M>,
{
    let residuals: [f64; M] = match system.holonomic(t, q) {
        Some(g) => from_fn(|k| g[k].unwrap_or(0.0)),
        None => [0.0; M],
    };
    crate::linear::largest(&residuals)
}
