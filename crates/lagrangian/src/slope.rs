use crate::gradient::by_places;
use crate::{Gradient, Scalar, System};

/// `L_q(t, q, v)`, the derivatives of the Lagrangian in the configuration.
#[inline(never)]
pub fn configuration_slope<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [S; N]
where
    Sys: System<N, M>,
    S: Scalar,
{
    by_places!(slope_by::<Sys, S, N, M>(system, t, q, v))
}

/// The same by derivatives in `W` places.
#[inline(always)]
fn slope_by<Sys, S, const N: usize, const M: usize, const W: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> [S; N]
where
    Sys: System<N, M>,
    S: Scalar,
{
    system.lagrangian(Gradient::<S, W>::fixed(t), &Gradient::variables(q), &Gradient::all_fixed(v)).gradient()
}
