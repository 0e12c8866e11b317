use super::path::PathPoints;
use super::rule::EnergyRule;
use super::start::EnergyStart;
use lagrangian::{Bracket, Lanes};

/// The energies at the two ends of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) before: f64,
    pub(super) after: f64,
    /// The size of the terms whose rounding they carry.
    pub(super) size: f64,
}

impl Ends {
    #[inline(always)]
    pub(super) fn of<const N: usize, const M: usize>(
        rule: &EnergyRule,
        bracket: &Bracket<Lanes, N, M>,
        points: &PathPoints<N>,
        begin: &EnergyStart<N>,
    ) -> Self {
        let (end, start) = rule.ends();
        // H_pi = xi makes up for what the iteration for xi still misses; a discrete gradient divides it by the step.
        let mut energy = bracket.energy();
        let missing = points.missing(begin);
        for a in 0..N {
            energy += points.xi[a] * missing[a];
        }
        let size = |k: usize| {
            let twice_kinetic = (0..N).map(|i| (bracket.momentum[i].0[k] * bracket.velocity[i].0[k]).abs());
            bracket.lagrangian.0[k].abs() + twice_kinetic.sum::<f64>()
        };
        Self { before: energy.0[start], after: energy.0[end], size: size(start).max(size(end)) }
    }

    /// The size of the numbers in whose last digits the energies are uncertain, the coordinates being rounded too.
    #[inline(always)]
    pub(super) fn rounded_size<const N: usize>(&self, q: &[f64; N], steepest: &[f64; N]) -> f64 {
        self.size + (0..N).map(|i| steepest[i] * q[i].abs()).sum::<f64>()
    }
}
