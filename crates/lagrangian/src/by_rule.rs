//! Discrete Lagrangians and constraints of quadrature rules.

use crate::basis::linear_basis;
use crate::discrete::{gradients, gradients_apart, on_line, residual_along};
use crate::second::{AT_ONCE, TwiceDifferentiable, second_derivatives, seed};
use crate::{
    AdmissibleBasis, Derivatives, DiscreteConstraint, DiscreteLagrangian, Dual, HyperDual, Rule, Scalar, System,
    constraint_residual, from_fn, mapped,
};

impl<R: Rule, Sys: System<N, M>, const N: usize, const M: usize> DiscreteLagrangian<Sys, N, M> for R {
    #[inline(always)]
    fn average<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> S {
        let mut sum: Option<S> = None;
        for node in self.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let term = system.lagrangian(t, &q, v) * node.weight;
            sum = Some(sum.map_or(term, |s| s + term));
        }
        sum.unwrap_or(S::zero())
    }

    /// Dual numbers are seeded at the nodes, where the configuration depends on both ends by `dq = (1 - alpha) dq0 + alpha dq1`: the nodes
    /// themselves are computed in plain numbers.
    #[inline]
    fn derivatives<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> Derivatives<S, N> {
        if const { N > AT_ONCE } {
            let l = second_derivatives(&AtNodes { rule: self, system, t0, h, q0, v });
            return Derivatives {
                value: h * l.re,
                d1: l.e1,
                d2: l.e2,
                d1d2: mapped(&l.e12, |row| mapped(&row, |x| x / h)),
            };
        }
        // Inlined here: called as a function, it makes a step of few coordinates a twentieth more instructions.
        let (zero, one) = (S::zero(), S::constant(1.0));
        let unit = |x: S, i: usize| -> [S; N] { from_fn(|k| if k == i { x } else { zero }) };
        let in_v: [HyperDual<S, N, N>; N] = from_fn(|i| HyperDual::linear(v[i], unit(-one, i), unit(one, i)));
        let mut sum: Option<HyperDual<S, N, N>> = None;
        for node in self.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let part = h * node.alpha;
            let in_q: [HyperDual<S, N, N>; N] = from_fn(|i| HyperDual::linear(q[i], unit(h - part, i), unit(part, i)));
            let term = system.lagrangian(HyperDual::fixed(t), &in_q, &in_v) * node.weight;
            sum = Some(sum.map_or(term, |s| s + term));
        }
        let l = sum.unwrap_or(HyperDual::fixed(zero));
        Derivatives { value: h * l.re, d1: l.e1, d2: l.e2, d1d2: mapped(&l.e12, |row| mapped(&row, |x| x / h)) }
    }

    #[inline(always)]
    fn slopes<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [[S; N]; 2] {
        slopes_at_nodes(self, system, (t0, h), q0, (v, v))
    }

    #[inline(always)]
    fn slopes_along(
        &self,
        system: &Sys,
        time: (f64, f64),
        q0: &[f64; N],
        way: &[f64; N],
        v: &[f64; N],
    ) -> [[f64; N]; 2] {
        slopes_at_nodes(self, system, time, q0, (way, v))
    }

    #[inline]
    fn d2<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [S; N] {
        let [_, d2] = DiscreteLagrangian::<Sys, N, M>::slopes(self, system, t0, h, q0, v);
        d2
    }

    #[inline(always)]
    fn forces<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> Option<([S; N], [S; N])> {
        forces_at_nodes(self, system, (t0, h), q0, (v, v))
    }

    #[inline(always)]
    fn forces_along(
        &self,
        system: &Sys,
        time: (f64, f64),
        q0: &[f64; N],
        way: &[f64; N],
        v: &[f64; N],
    ) -> Option<([f64; N], [f64; N])> {
        forces_at_nodes(self, system, time, q0, (way, v))
    }
}

impl<R: Rule, Sys: System<N, M>, const N: usize, const M: usize> DiscreteConstraint<Sys, N, M> for R {
    #[inline(always)]
    fn residual<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [S; M] {
        let mut sum = [S::zero(); M];
        for node in self.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let residual = constraint_residual(system, t, &q, v);
            for k in 0..M {
                sum[k] += residual[k] * node.weight;
            }
        }
        sum
    }

    /// Seeded at the nodes.
    #[inline]
    fn linearised(&self, system: &Sys, t0: f64, h: f64, q0: &[f64; N], v: &[f64; N]) -> [Dual<f64, N>; M] {
        let mut sum = [Dual::fixed(0.0); M];
        for node in self.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let at_node = residual_along(system, t, &q, v, h * node.alpha);
            for k in 0..M {
                sum[k] += at_node[k] * node.weight;
            }
        }
        sum
    }

    /// Of a single node, where the constraints are linear.
    #[inline(always)]
    fn basis_along(
        &self,
        system: &Sys,
        (t0, h): (f64, f64),
        q0: &[f64; N],
        way: &[f64; N],
    ) -> Option<AdmissibleBasis<f64, N, M>> {
        let [node] = self.nodes() else { return None };
        let (t, q) = on_line(node.alpha, t0, h, q0, way);
        linear_basis(system, t, &q).map(|(_, basis)| basis)
    }
}

/// `D1 L_d` and `D2 L_d` by the derivatives in the configuration and the velocity `v` at every node; nodes are placed by the mean velocity
/// `way`.
#[inline(always)]
fn slopes_at_nodes<R: Rule, Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    rule: &R,
    system: &Sys,
    (t0, h): (S, S),
    q0: &[S; N],
    (way, v): (&[S; N], &[S; N]),
) -> [[S; N]; 2] {
    let [mut d1, mut d2] = [[S::zero(); N]; 2];
    for node in rule.nodes() {
        let (t, q) = on_line(node.alpha, t0, h, q0, way);
        let part = h * node.alpha;
        let [l_q, l_v] = match const { R::IN_PLACE } {
            true => gradients(system, t, &q, v),
            false => gradients_apart(system, t, &q, v),
        };
        for i in 0..N {
            d1[i] += ((h - part) * l_q[i] - l_v[i]) * node.weight;
            d2[i] += (part * l_q[i] + l_v[i]) * node.weight;
        }
    }
    [d1, d2]
}

/// `f_d^-` and `f_d^+` by the forces at every node, in the same way.
#[inline(always)]
fn forces_at_nodes<R: Rule, Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    rule: &R,
    system: &Sys,
    (t0, h): (S, S),
    q0: &[S; N],
    (way, v): (&[S; N], &[S; N]),
) -> Option<([S; N], [S; N])> {
    let (mut minus, mut plus) = ([S::zero(); N], [S::zero(); N]);
    for node in rule.nodes() {
        let (t, q) = on_line(node.alpha, t0, h, q0, way);
        let force = system.force(t, &q, v)?;
        for i in 0..N {
            let impulse = h * force[i] * node.weight;
            minus[i] += impulse * (1.0 - node.alpha);
            plus[i] += impulse * node.alpha;
        }
    }
    Some((minus, plus))
}

/// A mean Lagrangian by a rule as a function of both ends of the step.
///
/// In the units of h of `OfPair`.
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
