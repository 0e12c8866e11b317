//! First derivatives of the Lagrangian for evaluations that are made seldom: compiled small rather than quick.

use crate::{Called, Gradient, Scalar, System, from_fn, mapped};

/// `L_q(t, q, v)`, the derivatives of the Lagrangian in the configuration.
#[inline(never)]
pub fn configuration_slope<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [S; N]
where
    Sys: System<N, M>,
    S: Scalar,
{
    system.lagrangian(fixed(t), &variables(q), &mapped(v, fixed)).0.gradient()
}

/// `L_v(t, q, v)`: the same numbers as [`momentum`](crate::momentum).
#[inline(never)]
pub fn velocity_slope<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [S; N]
where
    Sys: System<N, M>,
    S: Scalar,
{
    system.lagrangian(fixed(t), &mapped(q, fixed), &variables(v)).0.gradient()
}

fn fixed<S: Scalar, const N: usize>(x: S) -> Called<Gradient<S, N>> {
    Called(Gradient::fixed(x))
}

fn variables<S: Scalar, const N: usize>(x: &[S; N]) -> [Called<Gradient<S, N>>; N] {
    from_fn(|i| Called(Gradient::variable(x[i], i)))
}
