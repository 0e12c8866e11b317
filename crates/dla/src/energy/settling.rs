use crate::{History, Newton, NewtonError};

/// The stopping rule of the fixed-point iteration: at rounding, every component by itself.
///
/// A component is settled when linear convergence, at the rate of the last two iterations, predicts a next change below a
/// 64th of an ulp; or when its changes are below [`Newton::ROUNDING`] of the largest component, or below
/// the noise of the equations, and twice have not shrunk, so that they are rounding. Far from the origin the rounding of
/// the coordinates is more than that; changes of up to [`FAR`] times as much must fail to shrink more often. Stopping any
/// earlier would leave an error of the same sign in every step.
#[derive(Debug)]
pub(super) struct Settling<const G: usize, const N: usize> {
    components: [[Component; N]; G],
    least: f64,
    iteration: u32,
    history: History,
}

/// See [`Settling`].
const FAR: f64 = 1e4;

/// What is remembered of a component: its last two changes, and how often they have not shrunk.
#[derive(Debug, Clone, Copy)]
struct Component {
    last: f64,
    before_last: f64,
    stalls: u32,
    far_stalls: u32,
}

impl<const G: usize, const N: usize> Settling<G, N> {
    /// Iterations after which the search is given up.
    const LIMIT: u32 = 200;
    /// Changes that oscillate may grow for a while, by as much as this.
    const GROWTH: f64 = 1e3;
    /// Faster convergence than this is taken for an accident, slower convergence than the other for none.
    const RATES: (f64, f64) = (0.02, 0.9);

    pub(super) fn new() -> Self {
        let component = Component { last: f64::INFINITY, before_last: f64::INFINITY, stalls: 0, far_stalls: 0 };
        Self { components: [[component; N]; G], least: f64::INFINITY, iteration: 0, history: History::new() }
    }

    /// Sees the largest changes and sizes of the components after an iteration; the iteration's number if it was the last.
    ///
    /// # Errors
    /// [`NewtonError`] where the iteration leads nowhere.
    #[inline(always)]
    pub(super) fn see(&mut self, groups: [[(f64, f64); N]; G], noise: f64) -> Result<Option<u32>, NewtonError> {
        self.iteration += 1;
        let iteration = self.iteration;
        let (mut settled, mut worst) = (true, 0.0_f64);
        // A group whose true value is zero has no size of its own to diverge from.
        let overall = groups.iter().flatten().fold(0.0, |m: f64, (_, size)| m.max(*size));
        for (group, components) in groups.iter().zip(&mut self.components) {
            for (&(change, size), component) in group.iter().zip(components) {
                if !(change.is_finite() && size.is_finite()) {
                    return Err(NewtonError::NotFinite { iteration, history: self.history });
                }
                settled &= component.settles(change, size, noise.max(Newton::ROUNDING * overall));
                if change > noise {
                    worst = worst.max(change / overall);
                }
            }
        }
        if settled {
            return Ok(Some(iteration));
        }
        self.history.push(worst);
        let history = self.history;
        if worst > Self::GROWTH * self.least.max(Newton::ROUNDING) {
            return Err(NewtonError::Diverged { iteration, correction: worst, before: self.least, history });
        }
        if iteration == Self::LIMIT {
            return Err(NewtonError::IterationLimit { iterations: iteration, correction: worst, history });
        }
        self.least = self.least.min(worst);
        Ok(None)
    }
}

impl Component {
    #[inline(always)]
    fn settles(&mut self, change: f64, size: f64, rounding: f64) -> bool {
        let (fast, slow) = Settling::<0, 0>::RATES;
        let rate = (change / self.last).max((change / self.before_last).sqrt()).max(fast);
        // Before there is a rate, only no change at all settles.
        let next = if self.last.is_finite() && rate < slow { change * rate / (1.0 - rate) } else { change };
        if change >= slow * self.last.max(self.before_last) {
            self.stalls += u32::from(change <= rounding);
            self.far_stalls += u32::from(change <= FAR * rounding);
        }
        (self.before_last, self.last) = (self.last, change);
        self.stalls >= 2 || self.far_stalls >= 6 || next <= f64::EPSILON / 64.0 * size
    }
}
