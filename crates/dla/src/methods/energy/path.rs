use super::rule::{EnergyRule, Weights};
use super::start::EnergyStart;
use lagrangian::{Lanes, Scalar, from_fn, mapped};

/// The path of a step, a polynomial in the coordinates and the quasi-momenta: its derivatives at the collocation nodes,
/// one in each of the first lanes.
#[derive(Debug, Clone, Copy)]
pub(super) struct EnergyPath<const N: usize> {
    pub(super) q_rate: [Lanes; N],
    pub(super) pi_rate: [Lanes; N],
}

impl<const N: usize> EnergyPath<N> {
    /// No motion.
    #[inline(always)]
    pub(super) fn rest() -> Self {
        Self { q_rate: [Lanes::zero(); N], pi_rate: [Lanes::zero(); N] }
    }

    /// The increments of coordinates and quasi-momenta over the step.
    #[inline(always)]
    pub(super) fn increments(&self, rule: &EnergyRule, h: f64) -> ([f64; N], [f64; N]) {
        let sum = |k: &Lanes| h * rule.weighted(k);
        (from_fn(|i| sum(&self.q_rate[i])), from_fn(|i| sum(&self.pi_rate[i])))
    }
}

/// Eight points on the path, with approximate quasi-velocities.
#[derive(Debug, Clone, Copy)]
pub(super) struct PathPoints<const N: usize> {
    pub(super) q: [Lanes; N],
    pub(super) xi: [Lanes; N],
    /// The quasi-momenta gained on the path since the start.
    pub(super) gain: [Lanes; N],
    /// The quasi-momenta of `q` and `xi`, as last evaluated.
    pub(super) pi: [Lanes; N],
}

impl<const N: usize> PathPoints<N> {
    /// All at the start of the step.
    #[inline(always)]
    pub(super) fn at(start: &EnergyStart<N>) -> Self {
        let same = |x: [f64; N]| mapped(&x, Lanes::constant);
        Self { q: same(*start.state.q()), xi: same(start.xi), gain: same(start.rest), pi: same(start.pi) }
    }

    /// Moves the points onto `path`; `weights` are `int_0^tau l_i`.
    ///
    /// The quasi-velocities follow the quasi-momenta by one correction with the mass matrix of the start. The correction is exact if that
    /// matrix is constant in the basis; otherwise it is part of the fixed-point iteration.
    #[inline(always)]
    pub(super) fn follow(&mut self, path: &EnergyPath<N>, weights: &[Weights], start: &EnergyStart<N>, h: f64) {
        let mut increment = [Lanes::zero(); N];
        for i in 0..N {
            increment[i] = moved(&path.q_rate[i], weights) * h;
            self.gain[i] = moved(&path.pi_rate[i], weights) * h + start.rest[i];
        }
        for k in 0..Lanes::COUNT {
            let q = start.state.ahead(&from_fn(
                #[inline(always)]
                |i| increment[i].0[k],
            ));
            for i in 0..N {
                self.q[i].0[k] = q[i];
            }
        }
        let missing = self.missing(start);
        for a in 0..N {
            for b in 0..N {
                self.xi[a] += missing[b] * start.inverse_mass[a][b];
            }
        }
    }
    /// The quasi-momenta on the path minus the ones last evaluated. Differences from the start keep the digits.
    #[inline(always)]
    pub(super) fn missing(&self, start: &EnergyStart<N>) -> [Lanes; N] {
        from_fn(|a| self.gain[a] - (self.pi[a] + -start.pi[a]))
    }
}

/// The integral of a rate from the start to each of the points, by the step.
#[inline(always)]
fn moved(rate: &Lanes, weights: &[Weights]) -> Lanes {
    let (mut sum, mut rest) = (Lanes::zero(), Lanes::zero());
    for (weights, rate) in weights.iter().zip(rate.0) {
        weights.add(rate, &mut sum, &mut rest);
    }
    sum + rest
}
