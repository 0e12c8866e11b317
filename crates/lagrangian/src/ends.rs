use crate::discrete::on_line;
use crate::second::{TwiceDifferentiable, seed};
use crate::{DiscreteLagrangian, HyperDual, Rule, Scalar, System, from_fn};

/// A mean Lagrangian as a function of both ends of the step.
///
/// In units of h these are a = q0/h and b = q1/h: then q0 = h a, v = b - a, and D1 L_d is the derivative of L_d/h in a.
pub(crate) struct OfPair<'a, L: ?Sized, Sys, S, const N: usize, const M: usize> {
    pub(crate) of: &'a L,
    pub(crate) system: &'a Sys,
    pub(crate) t0: S,
    pub(crate) h: S,
    pub(crate) q0: &'a [S; N],
    pub(crate) v: &'a [S; N],
}

impl<L, Sys, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N> for OfPair<'_, L, Sys, S, N, M>
where
    L: DiscreteLagrangian<Sys, N, M> + ?Sized,
{
    const SYMMETRIC: bool = false;

    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P> {
        let Self { of, system, t0, h, q0, v } = *self;
        let (zero, one) = (S::zero(), S::constant(1.0));
        let q0: [HyperDual<S, P, P>; N] = from_fn(|i| HyperDual::linear(q0[i], seed(h, i, first), [zero; P]));
        let v: [HyperDual<S, P, P>; N] =
            from_fn(|i| HyperDual::linear(v[i], seed(-one, i, first), seed(one, i, second)));
        of.average(system, HyperDual::fixed(t0), HyperDual::fixed(h), &q0, &v)
    }
}

/// The same by a rule.
pub(crate) struct AtNodes<'a, R, Sys, S, const N: usize, const M: usize> {
    pub(crate) rule: &'a R,
    pub(crate) system: &'a Sys,
    pub(crate) t0: S,
    pub(crate) h: S,
    pub(crate) q0: &'a [S; N],
    pub(crate) v: &'a [S; N],
}

impl<R: Rule, Sys: System<N, M>, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N>
    for AtNodes<'_, R, Sys, S, N, M>
{
    const SYMMETRIC: bool = false;

    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P> {
        let Self { rule, system, t0, h, q0, v } = *self;
        let one = S::constant(1.0);
        let in_v: [HyperDual<S, P, P>; N] =
            from_fn(|i| HyperDual::linear(v[i], seed(-one, i, first), seed(one, i, second)));
        let mut sum: Option<HyperDual<S, P, P>> = None;
        for node in rule.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let part = h * node.alpha;
            let in_q: [HyperDual<S, P, P>; N] =
                from_fn(|i| HyperDual::linear(q[i], seed(h - part, i, first), seed(part, i, second)));
            let term = system.lagrangian(HyperDual::fixed(t), &in_q, &in_v) * node.weight;
            sum = Some(sum.map_or(term, |s| s + term));
        }
        sum.unwrap_or(HyperDual::fixed(S::zero()))
    }
}
