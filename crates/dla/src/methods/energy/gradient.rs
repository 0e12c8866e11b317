use super::path::PathPoints;
use super::rule::EnergyRule;
use crate::Mechanics;
use lagrangian::{Lanes, Scalar, mapped};

/// Averages of the energy's gradient, one for each collocation node in its lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Averages<const N: usize> {
    pub(super) h_q: [Lanes; N],
    /// The averages of `H_pi = xi`.
    pub(super) h_pi: [Lanes; N],
    /// The largest `|H_q|` of the points.
    pub(super) steepest: [f64; N],
}

/// `int_0^1 (l_i / b_i) grad H(u) dsigma`.
#[inline(always)]
pub(super) fn average<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    rule: &EnergyRule,
    t: Lanes,
    nodes: &mut PathPoints<N>,
) -> Option<Averages<N>> {
    let slope = system.energy_slope(t, &nodes.q, &nodes.xi)?;
    nodes.pi = slope.pi;
    let steepest = mapped(&slope.h_q, |h| h.0.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
    Some(Averages { h_q: means(rule, &slope.h_q), h_pi: means(rule, &nodes.xi), steepest })
}

/// The averages `int_0^1 (l_i / b_i) x dsigma` of numbers at the nodes of the quadrature.
#[inline(always)]
fn means<const N: usize>(rule: &EnergyRule, x: &[Lanes; N]) -> [Lanes; N] {
    let mut means = [Lanes::zero(); N];
    for (x, mean) in x.iter().zip(&mut means) {
        for (weights, mean) in rule.averages().iter().zip(&mut mean.0) {
            let (mut terms, mut rest) = (Lanes::zero(), Lanes::zero());
            weights.add(*x, &mut terms, &mut rest);
            *mean = terms.0.iter().sum::<f64>() + rest.0.iter().sum::<f64>();
        }
    }
    means
}
