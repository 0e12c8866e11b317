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
    let steepest = mapped(&slope.h_q, |h| h.0.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
    Some(Averages { h_q: mean(&slope.h_q), h_pi: mean(&nodes.xi), steepest })
}
