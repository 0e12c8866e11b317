use crate::{Gradient, HyperDual, Scalar, System};
use std::array::from_fn;

/// `L(t, q, v)` with its gradient in `v`.
#[inline(always)]
fn in_velocity<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> (S, [S; N])
where
    Sys: System<N, M>,
    S: Scalar,
{
    match N {
        5..=8 => in_velocity_by::<Sys, S, N, M, 8>(system, t, q, v),
        _ => in_velocity_by::<Sys, S, N, M, N>(system, t, q, v),
    }
}

/// The same by derivatives in `W` places, of which those beyond `N` are zero: whole registers are quicker.
#[inline(always)]
fn in_velocity_by<Sys, S, const N: usize, const M: usize, const W: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> (S, [S; N])
where
    Sys: System<N, M>,
    S: Scalar,
{
    let l = system.lagrangian(Gradient::<S, W>::fixed(t), &Gradient::all_fixed(q), &Gradient::variables(v));
    (l.re, l.gradient())
}

/// The momenta `p = dL/dv`.
#[inline]
pub fn momentum<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [S; N]
where
    Sys: System<N, M>,
    S: Scalar,
{
    in_velocity(system, t, q, v).1
}

/// The energy `E = v . dL/dv - L` (J).
#[inline]
pub fn energy<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> S
where
    Sys: System<N, M>,
    S: Scalar,
{
    let (l, p) = in_velocity(system, t, q, v);
    let mut energy = -l;
    for i in 0..N {
        energy += p[i] * v[i];
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
    l.gradient::<N>().iter().all(|p| p.gradient::<N>().iter().all(|m| m.is_finite()))
}
