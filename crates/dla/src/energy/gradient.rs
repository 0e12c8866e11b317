use super::ends::Ends;
use super::path::{Path, Points};
use super::rule::Rule;
use crate::Mechanics;
use lagrangian::{Lanes, Scalar};

/// Which discrete gradient of the energy a step takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Gradient {
    /// The average of the gradient along the path. (Quispel and McLaren 2008, J. Phys. A 41, 045206.)
    #[default]
    Average,
    /// The gradient in the middle, corrected along the increment of `(q, pi)`. (Gonzalez 1996, J. Nonlinear Sci. 6,
    /// 449-467.)
    ///
    /// Cheaper in evaluations, but it takes the energies at the ends, so that the rounding of coordinates far from the origin
    /// goes into the energy whole.
    Gonzalez,
}

/// Averages of the energy's gradient, one for each collocation node in its lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Averages<const N: usize> {
    pub(super) h_q: [Lanes; N],
    /// The averages of `H_pi = xi`.
    pub(super) h_pi: [Lanes; N],
    /// The largest `|H_q|` of the points.
    pub(super) steepest: [f64; N],
    /// How far rounding may move the averages from one iteration to the next, if further than that of the points.
    pub(super) noise: f64,
}

/// The steepest slope of eight points.
#[inline(always)]
fn steepest<const N: usize>(h_q: &[Lanes; N], lanes: usize) -> [f64; N] {
    h_q.map(|h| h.0[..lanes].iter().fold(0.0, |m: f64, x| m.max(x.abs())))
}

/// `int_0^1 (l_i / b_i) grad H(u) dsigma`.
#[inline(always)]
pub(super) fn average<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    rule: &Rule,
    t: Lanes,
    nodes: &mut Points<N>,
) -> Option<Averages<N>> {
    let slope = system.energy_slope(t, &nodes.q, &nodes.xi)?;
    nodes.pi = slope.pi;
    let mean = |values: &[Lanes; N]| {
        values.map(|value| {
            let mut result = Lanes::zero();
            for (weights, result) in rule.averages().iter().zip(&mut result.0) {
                let (mut terms, mut rest) = (Lanes::zero(), Lanes::zero());
                weights.add(value, &mut terms, &mut rest);
                *result = terms.0.iter().sum::<f64>() + rest.0.iter().sum::<f64>();
            }
            result
        })
    };
    Some(Averages {
        h_q: mean(&slope.h_q),
        h_pi: mean(&nodes.xi),
        steepest: steepest(&slope.h_q, Lanes::COUNT),
        noise: 0.0,
    })
}

/// `grad H(z) + k (z1 - z0)` at the middle `z`, with the `k` that makes its product with `z1 - z0` the change of energy.
///
/// Where the ends coincide `k` is `0/0`; it is left out where the change that it would correct is round-off.
#[inline(always)]
pub(super) fn gonzalez<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    rule: &Rule,
    t: Lanes,
    path: &Path<N>,
    points: &Points<N>,
    ends: &Ends,
    h: f64,
) -> Option<Averages<N>> {
    let slope = system.energy_slope(t, &points.q, &points.xi)?;
    let (mut h_q, mut h_pi) = (slope.h_q, points.xi);
    let (dq, dpi) = path.increments(rule, h);
    let (mut missing, mut square) = (ends.after - ends.before, 0.0);
    for i in 0..N {
        missing -= h_q[i].0[0] * dq[i] + h_pi[i].0[0] * dpi[i];
        square += dq[i] * dq[i] + dpi[i] * dpi[i];
    }
    let steepest = steepest(&slope.h_q, rule.ends().1 + 1);
    let rounding = f64::EPSILON * ends.rounded_size(&points.q.map(|q| q.0[0]), &steepest);
    if missing.abs() > rounding && square > 0.0 {
        let k = missing / square;
        for i in 0..N {
            h_q[i].0[0] += k * dq[i];
            h_pi[i].0[0] += k * dpi[i];
        }
    }
    let noise = if square > 0.0 { 16.0 * rounding / square.sqrt() } else { 0.0 };
    Some(Averages { h_q, h_pi, steepest, noise })
}
