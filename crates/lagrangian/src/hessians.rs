use crate::second::{TwiceDifferentiable, second_derivatives, seed};
use crate::{HyperDual, Scalar, System, from_fn, mapped};

/// The Lagrangian at a state, as a function of the coordinates or the velocities.
struct At<'a, Sys, S, const N: usize, const M: usize> {
    system: &'a Sys,
    t: S,
    q: &'a [S; N],
    v: &'a [S; N],
}

/// Both groups of variables are the velocities.
struct InVelocity<'a, Sys, S, const N: usize, const M: usize>(At<'a, Sys, S, N, M>);

/// Both are the coordinates.
struct InPlace<'a, Sys, S, const N: usize, const M: usize>(At<'a, Sys, S, N, M>);

/// The first are the coordinates, the second the velocities.
struct InBoth<'a, Sys, S, const N: usize, const M: usize>(At<'a, Sys, S, N, M>);

/// The first are the ends at the beginning of a step, the second those at its end, on whose line the state is a node.
struct AtNode<'a, Sys, S, const N: usize, const M: usize> {
    at: At<'a, Sys, S, N, M>,
    back: S,
    ahead: S,
}

/// The Lagrangian with its gradients along `(dq, dv) = (back, -1) e_i` and `(ahead, 1) e_j`, and the mixed second derivatives; with
/// `back = h (1 - alpha)` and `ahead = h alpha` what a node at the fraction `alpha` of a step adds to `D1 L_d`, `D2 L_d` and `h D1 D2 L_d`.
#[must_use]
#[inline(always)]
pub fn second_at_node<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
    back: S,
    ahead: S,
) -> HyperDual<S, N, N> {
    second_derivatives(&AtNode::<_, _, N, M> { at: At { system, t, q, v }, back, ahead })
}

/// The Lagrangian, its momenta `L_v` in both gradients, and the mass matrix `L_vv`. Inlined, so that code evaluated beside it shares the
/// sines and other functions of the configuration.
#[must_use]
#[inline(always)]
pub fn second_in_velocity<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> HyperDual<S, N, N> {
    second_derivatives(&InVelocity::<_, _, N, M>(At { system, t, q, v }))
}

/// The Lagrangian, `L_q` in both gradients, and `L_qq`.
#[must_use]
#[inline(always)]
pub fn second_in_place<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> HyperDual<S, N, N> {
    second_derivatives(&InPlace::<_, _, N, M>(At { system, t, q, v }))
}

/// The Lagrangian, `L_q`, `L_v`, and the mixed block with row `i` and column `j` the derivative in `q_i` and `v_j`.
#[must_use]
#[inline(always)]
pub fn second_in_both<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> HyperDual<S, N, N> {
    second_derivatives(&InBoth::<_, _, N, M>(At { system, t, q, v }))
}

impl<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N>
    for InVelocity<'_, Sys, S, N, M>
{
    const SYMMETRIC: bool = true;

    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P> {
        let At { system, t, q, v } = self.0;
        let one = S::constant(1.0);
        let in_v: [_; N] = from_fn(|i| HyperDual::linear(v[i], seed(one, i, first), seed(one, i, second)));
        system.lagrangian(HyperDual::fixed(t), &mapped(q, HyperDual::fixed), &in_v)
    }
}

impl<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N>
    for InPlace<'_, Sys, S, N, M>
{
    const SYMMETRIC: bool = true;

    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P> {
        let At { system, t, q, v } = self.0;
        let one = S::constant(1.0);
        let in_q: [_; N] = from_fn(|i| HyperDual::linear(q[i], seed(one, i, first), seed(one, i, second)));
        system.lagrangian(HyperDual::fixed(t), &in_q, &mapped(v, HyperDual::fixed))
    }
}

impl<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N>
    for InBoth<'_, Sys, S, N, M>
{
    const SYMMETRIC: bool = false;

    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P> {
        let At { system, t, q, v } = self.0;
        let (one, zero) = (S::constant(1.0), [S::zero(); P]);
        let in_q: [_; N] = from_fn(|i| HyperDual::linear(q[i], seed(one, i, first), zero));
        let in_v: [_; N] = from_fn(|i| HyperDual::linear(v[i], zero, seed(one, i, second)));
        system.lagrangian(HyperDual::fixed(t), &in_q, &in_v)
    }
}

impl<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N>
    for AtNode<'_, Sys, S, N, M>
{
    const SYMMETRIC: bool = false;

    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P> {
        let (At { system, t, q, v }, one) = (&self.at, S::constant(1.0));
        let in_q: [_; N] = from_fn(|i| HyperDual::linear(q[i], seed(self.back, i, first), seed(self.ahead, i, second)));
        let in_v: [_; N] = from_fn(|i| HyperDual::linear(v[i], seed(-one, i, first), seed(one, i, second)));
        system.lagrangian(HyperDual::fixed(*t), &in_q, &in_v)
    }
}
