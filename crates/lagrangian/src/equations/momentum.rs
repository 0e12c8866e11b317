use crate::by_places;
use crate::{Gradient, Scalar, System, second_along};

/// `L(t, q, v)` with its gradient in `v`, the momenta. Inlined, so that code evaluated beside it shares the sines and other functions of
/// the configuration; [`momentum`] and [`energy`] call one function.
#[must_use]
#[inline(always)]
pub fn gradient_in_velocity<Sys, S, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> (S, [S; N])
where
    Sys: System<N, M>,
    S: Scalar,
{
    by_places!(in_velocity_by::<Sys, S, N, M>(system, t, q, v))
}

/// The momenta by derivatives in `W` places.
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

#[inline(never)]
fn in_velocity<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> (S, [S; N]) {
    gradient_in_velocity(system, t, q, v)
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
    let l = second_along(system, t, (q, v), [S::zero(), S::constant(1.0)], None);
    (l.e1, l.e12)
}
