use super::tolerances::{CYCLES, GROWTH_OF_FIXED_POINT, QUIET, SLIGHT_OF_FIXED_POINT, STALLS, UNBIASED};
use crate::{History, NewtonError};
use lagrangian::{from_fn, mapped};

/// The test of a fixed-point iteration: every component by itself, in `G` groups of `N` components.
///
/// A component has converged when linear convergence, at the rate of the last two iterations, predicts a next change of less than
/// [`UNBIASED`] of it; or when its changes have twice not shrunk and are rounding: slight beside the largest component, or a few roundings
/// of its own terms. An earlier end would leave an error of the same sign in every step.
#[derive(Debug)]
pub struct FixedPoint<const G: usize, const N: usize> {
    components: [[Component; N]; G],
    /// Factors that take the groups to the unit of the first.
    units: [f64; G],
    /// The round-off of every component in the unit of the first group, once it has been asked for.
    noise: Option<[[f64; N]; G]>,
    /// The largest change of the last iteration.
    last: f64,
    /// The least so far of the largest changes of two iterations: if places and momenta change in turns, the one is small while the other
    /// is large, in their units.
    least: f64,
    /// Consecutive iterations that changed nothing but by round-off.
    quiet: u32,
    /// The relative change that may still be to come.
    left: f64,
    /// The largest change of the last iteration in the first group that counts as round-off of terms.
    rounding: f64,
    iteration: u32,
    limit: u32,
    history: History,
}

/// The last two changes of a component, and how often it stalled at round-off.
#[derive(Debug, Clone, Copy)]
struct Component {
    last: f64,
    before_last: f64,
    stalls: u32,
}

/// The estimated contraction factor is never taken below the first; above the second an iteration counts as not converging.
const RATES: (f64, f64) = (0.02, 0.9);

impl<const G: usize, const N: usize> FixedPoint<G, N> {
    /// An iteration that fails after `limit`.
    #[must_use]
    #[inline(always)]
    pub fn new(limit: u32) -> Self {
        let component = Component { last: f64::INFINITY, before_last: f64::INFINITY, stalls: 0 };
        Self {
            components: [[component; N]; G],
            units: [1.0; G],
            noise: None,
            last: f64::INFINITY,
            least: f64::INFINITY,
            quiet: 0,
            left: UNBIASED,
            rounding: 0.0,
            iteration: 0,
            limit,
            history: History::new(),
        }
    }

    /// Round-off of their terms that the unknowns of the first group are left with, in their unit; zero while none had to be asked for.
    #[must_use]
    #[inline(always)]
    pub fn rounding(&self) -> f64 {
        self.rounding
    }

    /// The test with the relative change `left`, in place of [`UNBIASED`].
    #[must_use]
    #[inline(always)]
    pub fn to(mut self, left: f64) -> Self {
        self.left = left;
        self
    }

    /// The test of groups that have different units: factors take each to the unit of the first, in which components are compared.
    #[must_use]
    #[inline(always)]
    pub fn in_units(mut self, units: [f64; G]) -> Self {
        self.units = units;
        self
    }

    /// The error if the last iteration led to a place in which the equations cannot be evaluated.
    #[cold]
    #[must_use]
    pub fn lost(&self) -> NewtonError {
        let (correction, before) = (f64::INFINITY, self.least);
        NewtonError::Diverged { iteration: self.iteration + 1, correction, before, history: self.history }
    }

    /// Tests the largest changes and sizes of the components after an iteration; the iteration's number if it was the last. `noise`
    /// gives the round-off of the components, `2^-53` times the sums of the sizes of their terms.
    ///
    /// # Errors
    /// [`NewtonError`] if the iteration does not converge.
    #[inline(always)]
    pub fn see(
        &mut self,
        groups: [[(f64, f64); N]; G],
        noise: impl FnOnce() -> [[f64; N]; G],
    ) -> Result<Option<u32>, NewtonError> {
        self.iteration += 1;
        let iteration = self.iteration;
        let (mut settled, mut asks, mut worst, mut noisiest) = (true, false, 0.0_f64, 0.0_f64);
        self.rounding = 0.0;
        let units = self.units;
        let groups: [_; G] = from_fn(|g| mapped(&groups[g], |(change, size)| (change * units[g], size * units[g])));
        // A group whose true value is zero has no size of its own to diverge from.
        let all = groups.iter().flatten().fold(0.0, |most: f64, (_, size)| most.max(*size));
        for (g, (group, components)) in groups.iter().zip(&mut self.components).enumerate() {
            for (i, (&(change, size), component)) in group.iter().zip(components).enumerate() {
                if !(change.is_finite() && size.is_finite()) {
                    return Err(NewtonError::NotFinite { iteration, history: self.history });
                }
                let known = self.noise.as_ref().map_or(0.0, |noise| CYCLES * noise[g][i]);
                let rounding = (SLIGHT_OF_FIXED_POINT * all).max(known).max(f64::MIN_POSITIVE);
                let (ends, stalls) = component.settles(change, size, rounding, self.left);
                settled &= ends;
                asks |= stalls && !ends && change > rounding;
                if change > rounding {
                    worst = worst.max(change);
                } else if g == 0 && known > 0.0 {
                    self.rounding = self.rounding.max(change);
                }
                noisiest = noisiest.max(rounding);
            }
        }
        // A cycle of round-off need not stall in every component.
        self.quiet = if worst == 0.0 { self.quiet + 1 } else { 0 };
        if settled || self.quiet >= QUIET {
            return Ok(Some(iteration));
        }
        self.history.push(worst / all);
        let history = self.history;
        // Changes that oscillate may grow for a while, up to this.
        let grown = GROWTH_OF_FIXED_POINT * self.least.max(noisiest);
        if self.noise.is_none() && (asks || worst > grown) {
            let noise = noise();
            self.noise = Some(from_fn(|g| mapped(&noise[g], |x| x * units[g])));
        } else if worst > grown {
            let (correction, before) = (worst / all, self.least / all);
            return Err(NewtonError::Diverged { iteration, correction, before, history });
        }
        if iteration >= self.limit {
            return Err(NewtonError::IterationLimit { iterations: iteration, correction: worst / all, history });
        }
        self.least = self.least.min(self.last.max(worst));
        self.last = worst;
        Ok(None)
    }
}

impl Component {
    /// Whether it has converged, and whether its change has stalled.
    #[inline(always)]
    fn settles(&mut self, change: f64, size: f64, rounding: f64, left: f64) -> (bool, bool) {
        let (fast, slow) = RATES;
        let rate = (change / self.last).max((change / self.before_last).sqrt()).max(fast);
        // Before there is a rate, only no change at all is convergence.
        let next = if self.last.is_finite() && rate < slow { change * rate / (1.0 - rate) } else { change };
        let stalls = change >= slow * self.last.max(self.before_last);
        self.stalls += u32::from(stalls && change <= rounding);
        (self.before_last, self.last) = (self.last, change);
        (self.stalls >= STALLS || next <= left * size, stalls)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The iterations of one component of the size one, whose terms are rounded to `noise`.
    fn iterations(changes: impl Fn(u32) -> f64, noise: f64) -> Result<u32, NewtonError> {
        let mut fixed_point = FixedPoint::<1, 1>::new(200);
        let mut k = 0;
        loop {
            k += 1;
            if let Some(made) = fixed_point.see([[(changes(k), 1.0)]], || [[noise]])? {
                return Ok(made);
            }
        }
    }

    /// Changes that shrink end by the predicted next one; changes that stall end at the round-off of the terms.
    #[test]
    fn an_iteration_ends_at_its_rounding() {
        assert_eq!(iterations(|k| 0.1_f64.powi(k as i32), 0.0).unwrap(), 17);
        let stalls = |k: u32| 0.1_f64.powi(k as i32).max(3e-9 * (1.0 + 0.3 * f64::from(k * 7 % 5)));
        assert!(iterations(stalls, 1e-9).unwrap() < 30);
        // The positive control: changes above round-off are not convergence, and growth is not.
        assert!(matches!(iterations(stalls, 1e-12), Err(NewtonError::IterationLimit { .. })));
        assert!(matches!(iterations(|k| 2.0_f64.powi(k as i32), 1e-12), Err(NewtonError::Diverged { .. })));
        assert!(matches!(iterations(|_| f64::NAN, 1.0), Err(NewtonError::NotFinite { .. })));
    }
}
