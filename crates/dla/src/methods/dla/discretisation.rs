use crate::Mechanics;
use lagrangian::{Dual, HyperDual, Rounded, Rule, from_fn, mapped, on_line};

/// A discrete Lagrangian and a discrete constraint, as the equations of a step ask for them: in numbers.
///
/// A pair `(q0, q1)` is given as `q0` and the mean velocity `v = (q1 - q0)/h`, a step by its time and length `(t0, h)`. [`Rules`] are
/// quadrature rules for both; a user writes a [`DiscreteLagrangian`](crate::DiscreteLagrangian).
pub trait Discretisation<const N: usize, const M: usize> {
    /// `D1 L_d` and `D2 L_d` with the discrete forces, at the mean velocity `v`.
    fn momenta(&self, system: &dyn Mechanics<N, M>, time: (f64, f64), q0: &[f64; N], v: &[f64; N]) -> EndMomenta<N>;

    /// The momenta, and the derivatives of `D1 L_d + f_d^-` in the mean velocity.
    fn linearised(
        &self,
        system: &dyn Mechanics<N, M>,
        time: (f64, f64),
        q0: &[f64; N],
        v: &[f64; N],
    ) -> (EndMomenta<N>, [[f64; N]; N]);

    /// `w_d`, in the units of `A v`.
    fn residual(&self, system: &dyn Mechanics<N, M>, time: (f64, f64), q0: &[f64; N], v: &[f64; N]) -> [f64; M];

    /// The residual with its derivatives in the mean velocity.
    fn rows(&self, system: &dyn Mechanics<N, M>, time: (f64, f64), q0: &[f64; N], v: &[f64; N]) -> [Dual<f64, N>; M];

    /// `D1 L_d` and `f_d^-`, and `w_d`, with bounds on the rounding of their terms; the velocity has its own.
    fn rounded(
        &self,
        system: &dyn Mechanics<N, M>,
        time: (f64, f64),
        q0: &[f64; N],
        v: &[Rounded; N],
    ) -> RoundedStep<N, M>;
}

/// `[D1 L_d, D2 L_d]`, and `[f_d^-, f_d^+]` if there are forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndMomenta<const N: usize> {
    /// The derivatives of the discrete Lagrangian.
    pub slopes: [[f64; N]; 2],
    /// The discrete forces; `None` if there are no forces.
    pub forces: Option<[[f64; N]; 2]>,
}

/// The result of [`Discretisation::rounded`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundedStep<const N: usize, const M: usize> {
    /// `D1 L_d`.
    pub d1: [Rounded; N],
    /// `f_d^-`.
    pub minus: Option<[Rounded; N]>,
    /// `w_d`.
    pub residual: [Rounded; M],
}

/// A quadrature rule for the discrete Lagrangian and the discrete forces, and one for the discrete constraint.
///
/// Rules are values, not types: a step is compiled once for all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// The rule of `L_d`.
    pub lagrangian: Rule,
    /// The rule of `w_d`.
    pub constraint: Rule,
}

impl Rules {
    /// The pair.
    pub fn new(lagrangian: impl Into<Rule>, constraint: impl Into<Rule>) -> Self {
        Self { lagrangian: lagrangian.into(), constraint: constraint.into() }
    }
}

impl<const N: usize, const M: usize> Discretisation<N, M> for Rules {
    /// By the derivatives in configuration and velocity at every node.
    #[inline]
    fn momenta(&self, system: &dyn Mechanics<N, M>, (t0, h): (f64, f64), q0: &[f64; N], v: &[f64; N]) -> EndMomenta<N> {
        let [mut d1, mut d2] = [[0.0; N]; 2];
        let mut forces = Some([[0.0; N]; 2]);
        for node in self.lagrangian.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let part = h * node.alpha;
            let slopes = system.slopes(t, &q, v);
            for i in 0..N {
                d1[i] += ((h - part) * slopes.l_q[i] - slopes.l_v[i]) * node.weight;
                d2[i] += (part * slopes.l_q[i] + slopes.l_v[i]) * node.weight;
            }
            let Some((force, [minus, plus])) = slopes.force.zip(forces.as_mut()) else {
                forces = None;
                continue;
            };
            for i in 0..N {
                let impulse = h * force[i] * node.weight;
                minus[i] += impulse * (1.0 - node.alpha);
                plus[i] += impulse * node.alpha;
            }
        }
        EndMomenta { slopes: [d1, d2], forces }
    }

    /// Dual numbers are seeded at the nodes, whose configuration depends on both ends by `dq = (1 - alpha) dq0 + alpha dq1`: the nodes
    /// themselves are computed in plain numbers.
    #[inline]
    fn linearised(
        &self,
        system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        q0: &[f64; N],
        v: &[f64; N],
    ) -> (EndMomenta<N>, [[f64; N]; N]) {
        let mut sum: Option<HyperDual<f64, N, N>> = None;
        let mut forces = Some(([[0.0; N]; 2], [[0.0; N]; N]));
        for node in self.lagrangian.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let part = h * node.alpha;
            add_weighted(&mut sum, system.at_node(t, &q, v, h - part, part), node.weight);
            let along = if forces.is_some() { system.force_along(t, &q, v, part, 1.0) } else { None };
            let Some((force, ([minus, plus], block))) = along.zip(forces.as_mut()) else {
                forces = None;
                continue;
            };
            for i in 0..N {
                let impulse = force[i] * h * node.weight;
                minus[i] += impulse.re * (1.0 - node.alpha);
                plus[i] += impulse.re * node.alpha;
                for j in 0..N {
                    block[i][j] += impulse.eps[j] * (1.0 - node.alpha);
                }
            }
        }
        let l = sum.unwrap_or(HyperDual::fixed(0.0));
        let mut block = l.e12;
        if let Some((_, of_forces)) = &forces {
            for i in 0..N {
                for j in 0..N {
                    block[i][j] += of_forces[i][j];
                }
            }
        }
        (EndMomenta { slopes: [l.e1, l.e2], forces: forces.map(|(ends, _)| ends) }, block)
    }

    #[inline]
    fn residual(&self, system: &dyn Mechanics<N, M>, (t0, h): (f64, f64), q0: &[f64; N], v: &[f64; N]) -> [f64; M] {
        let mut sum = [0.0; M];
        for node in self.constraint.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let residual = system.residual(t, &q, v);
            for k in 0..M {
                sum[k] += residual[k] * node.weight;
            }
        }
        sum
    }

    #[inline]
    fn rows(
        &self,
        system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        q0: &[f64; N],
        v: &[f64; N],
    ) -> [Dual<f64, N>; M] {
        let mut sum = [Dual::fixed(0.0); M];
        for node in self.constraint.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let at_node = system.residual_along(t, &q, v, h * node.alpha);
            for k in 0..M {
                sum[k] += at_node[k] * node.weight;
            }
        }
        sum
    }

    #[cold]
    fn rounded(
        &self,
        system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        q0: &[f64; N],
        v: &[Rounded; N],
    ) -> RoundedStep<N, M> {
        let (t0, h, q0) = (Rounded::exact(t0), Rounded::exact(h), mapped(q0, Rounded::exact));
        let zero = Rounded::exact(0.0);
        let (mut d1, mut minus, mut residual) = ([zero; N], Some([zero; N]), [zero; M]);
        for node in self.lagrangian.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, &q0, v);
            let (l_q, l_v) = (system.slope_rounded(t, &q, v), system.momentum_rounded(t, &q, v));
            d1 = from_fn(|i| d1[i] + ((h - h * node.alpha) * l_q[i] - l_v[i]) * node.weight);
            minus = minus
                .zip(system.force_rounded(t, &q, v))
                .map(|(minus, force)| from_fn(|i| minus[i] + h * force[i] * node.weight * (1.0 - node.alpha)));
        }
        for node in self.constraint.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, &q0, v);
            let at_node = system.residual_rounded(t, &q, v);
            residual = from_fn(|k| residual[k] + at_node[k] * node.weight);
        }
        RoundedStep { d1, minus, residual }
    }
}

/// Adds `weight * term` in place: of a large system a copy is a good part of the stack of a thread.
#[inline]
fn add_weighted<const N: usize>(sum: &mut Option<HyperDual<f64, N, N>>, term: HyperDual<f64, N, N>, weight: f64) {
    let Some(sum) = sum else {
        let first = sum.insert(term);
        first.re *= weight;
        for i in 0..N {
            first.e1[i] *= weight;
            first.e2[i] *= weight;
            first.e12[i].iter_mut().for_each(|x| *x *= weight);
        }
        return;
    };
    sum.re += term.re * weight;
    for i in 0..N {
        sum.e1[i] += term.e1[i] * weight;
        sum.e2[i] += term.e2[i] * weight;
        for j in 0..N {
            sum.e12[i][j] += term.e12[i][j] * weight;
        }
    }
}
