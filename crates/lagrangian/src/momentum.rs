use crate::{Dual, Gradient, HyperDual, Scalar, System};
use std::array::from_fn;

/// `L(t, q, v)` with its gradient in `v`.
#[inline(always)]
fn in_velocity<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> Dual<S, N>
where
    Sys: System<N, M>,
    S: Scalar,
{
    system.lagrangian(Dual::fixed(t), &q.map(Dual::fixed), &Dual::variables(v))
}

/// The momenta `p = dL/dv`.
#[inline]
pub fn momentum<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [S; N]
where
    Sys: System<N, M>,
    S: Scalar,
{
    match N {
        ..=4 => momentum_by::<Sys, S, N, M, 4>(system, t, q, v),
        5..=8 => momentum_by::<Sys, S, N, M, 8>(system, t, q, v),
        _ => momentum_by::<Sys, S, N, M, N>(system, t, q, v),
    }
}

#[inline(always)]
fn momentum_by<Sys, S, const N: usize, const M: usize, const W: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [S; N]
where
    Sys: System<N, M>,
    S: Scalar,
{
    let l_v = system.lagrangian(Gradient::<S, W>::fixed(t), &Gradient::all_fixed(q), &Gradient::variables(v)).gradient();
    from_fn(|i| l_v[i])
}

/// The energy `E = v . dL/dv - L` (J).
#[inline]
pub fn energy<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> S
where
    Sys: System<N, M>,
    S: Scalar,
{
    let l = in_velocity(system, t, q, v);
    let mut energy = -l.re;
    for i in 0..N {
        energy += l.eps[i] * v[i];
    }
    energy
}

/// The momenta `p = dL/dv` and the mass matrix `d^2 L / dv dv`.
#[inline]
pub fn mass_matrix<Sys, S, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> ([S; N], [[S; N]; N])
where
    Sys: System<N, M>,
    S: Scalar,
{
    let v: [HyperDual<S, N, N>; N] = from_fn(|i| {
        let unit = from_fn(|k| S::constant(if k == i { 1.0 } else { 0.0 }));
        HyperDual::linear(v[i], unit, unit)
    });
    let l = system.lagrangian(HyperDual::fixed(t), &q.map(HyperDual::fixed), &v);
    (l.e1, l.e12)
}

/// Whether the mass matrix `d^2 L / dv dv` is the same at every time and place and for every velocity, as far as the text of the
/// Lagrangian shows it: nothing that depends on them enters it.
#[must_use]
#[cold]
#[inline(never)]
pub fn mass_is_constant<Sys, const N: usize, const M: usize>(system: &Sys) -> bool
where
    Sys: System<N, M>,
{
    // What is not a number makes none of all that it enters.
    let unknown = Gradient::fixed(f64::NAN);
    let v: [Gradient<Gradient<f64, N>, N>; N] = from_fn(|i| Gradient::variable(Gradient::variable(f64::NAN, i), i));
    let l = system.lagrangian(Gradient::fixed(unknown), &[Gradient::fixed(unknown); N], &v);
    l.gradient().iter().all(|p| p.gradient().iter().all(|m| m.is_finite()))
}
