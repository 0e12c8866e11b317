use super::tolerances::{
    BLIND, CONTRACTION, GONE, GROWTHS, NEAR_ROUNDINGS, OF_CORRECTION, ROUNDINGS, SHRINKING, STALL, UNBIASED, is_slight,
};
use crate::{History, NewtonError};
use lagrangian::linear::largest;

/// How one correction follows from another, which predicts the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CorrectionKind {
    /// With the Jacobian of the point itself: with `w` the bound on the curvature, a correction `d` leaves `w d^2/2`.
    Newton,
    /// With the Jacobian of the point before: the first is `d = w d_before^2/2`, and leaves `w d_before d`.
    Simplified,
    /// As simplified, with the frozen Jacobian of an earlier step, which must be good: an iteration whose corrections do not shrink eightfold
    /// fails.
    Frozen,
    /// With the frozen Jacobian of an earlier step: each shrinks by the same factor. Of thousands of components some always shrink a
    /// little by chance; so a component whose correction is round-off beside the largest one counts as converged.
    Chord,
}

impl CorrectionKind {
    /// Whether it goes with a Jacobian of another point, and the unknowns are few.
    fn is_simplified(self) -> bool {
        matches!(self, Self::Simplified | Self::Frozen)
    }
}

/// The settings of the convergence test for a correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// How the correction was made.
    pub kind: CorrectionKind,
    /// Relative tolerance of every component.
    pub tolerance: f64,
    /// Corrections after which the iteration fails.
    pub limit: u32,
    /// Whether the linear equations can still be solved with less round-off.
    pub refinable: bool,
    /// A correction below this leads to no other solution: it moves the place of the step by its rounding only
    /// ([`rounding_of_place`]).
    pub near: f64,
}

/// The velocity that moves the configuration `q` by its round-off only, in a step of length `h`. The last digits of `q` cause corrections
/// of this size in a constraint on positions, however slow the motion is.
#[must_use]
#[inline(always)]
pub fn rounding_of_place(q: &[f64], h: f64) -> f64 {
    NEAR_ROUNDINGS * 0.5 * f64::EPSILON * largest(q) / h.abs()
}

/// The convergence test of Newton's method, with any of its approximations, on any number of unknowns.
///
/// A component has converged when its correction is below the tolerance relative to it, or the next one is predicted to be; or when
/// it stalls and the residuals of all equations are round-off of their terms; or when simplified corrections take it to zero.
#[derive(Debug)]
pub struct Convergence<'a> {
    /// The last corrections of the components.
    last: &'a mut [f64],
    /// The components of which a check has shown that they move by round-off only.
    rounding: &'a mut [bool],
    /// The components at the start: one that goes to zero is known by them.
    start: &'a [f64],
    /// The largest component so far, the start's too: a solution of zeros only has no size of its own.
    size: f64,
    before: f64,
    growths: u32,
    history: History,
    first: f64,
    /// Whether the next correction is to show that the iteration contracts.
    watched: bool,
    certain: bool,
    /// Whether a check has shown that the residuals are round-off.
    met: bool,
    /// Whether corrections stall although the residuals are not round-off.
    unmet: bool,
    made: u32,
}

impl<'a> Convergence<'a> {
    /// An iteration that starts at `start`, with memory for as many components.
    #[inline(always)]
    pub fn new(last: &'a mut [f64], rounding: &'a mut [bool], start: &'a [f64]) -> Self {
        last.fill(f64::INFINITY);
        rounding.fill(false);
        Self {
            last,
            rounding,
            start,
            size: largest(start),
            before: f64::INFINITY,
            growths: 0,
            history: History::new(),
            first: 0.0,
            watched: false,
            certain: true,
            met: false,
            unmet: false,
            made: 0,
        }
    }

    /// The corrections so far, relative to the largest component there was.
    #[inline]
    #[must_use]
    pub fn history(&self) -> History {
        self.history.relative_to(self.size)
    }

    /// How many corrections have been made.
    #[inline(always)]
    #[must_use]
    pub fn made(&self) -> u32 {
        self.made
    }

    /// The size of the first correction.
    #[inline(always)]
    #[must_use]
    pub fn first(&self) -> f64 {
        self.first
    }

    /// Whether the iteration contracted from its start, so that its result is the solution near there.
    #[inline(always)]
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.certain
    }

    /// Whether corrections stall although the residuals are not round-off of their terms: the corrections are round-off of the linear
    /// equations.
    #[inline(always)]
    #[must_use]
    pub fn is_unmet(&self) -> bool {
        self.unmet
    }

    /// Tests a correction that leads to `x`: whether every component has converged. `roundings` gives the largest residual from which the
    /// correction was made, in units of the round-off of its terms; `None` if the equations do not know.
    ///
    /// # Errors
    /// [`NewtonError`] if the iteration does not converge.
    #[inline(always)]
    pub fn check(
        &mut self,
        demand: Demand,
        x: &[f64],
        correction: &[f64],
        roundings: impl FnOnce() -> Option<f64>,
    ) -> Result<bool, NewtonError> {
        let Demand { kind, tolerance, limit, refinable, near } = demand;
        self.made += 1;
        let iteration = self.made;
        let now = largest(x);
        if !now.is_finite() {
            return Err(NewtonError::NotFinite { iteration, history: self.history() });
        }
        self.size = self.size.max(now);
        let (step, size, before) = (largest(correction), self.size, self.before);
        self.history.push(step);
        if iteration == 1 {
            self.first = step;
        }
        let slight = is_slight(step, size);
        if kind == CorrectionKind::Frozen && !(slight || step <= SHRINKING * before) {
            let (correction, before, history) = (step / size, before / size, self.history());
            return Err(NewtonError::Diverged { iteration, correction, before, history });
        }
        let contracts = !self.watched || slight || step <= near || step <= CONTRACTION * before;
        let least = if kind == CorrectionKind::Chord { tolerance * size } else { 0.0 };
        let [mut settled, mut stalls] = [true, false];
        for i in 0..x.len() {
            let (d, x, last) = (correction[i].abs(), x[i].abs(), self.last[i]);
            let stall = d >= STALL * last;
            // A component that moves by round-off stays so.
            self.rounding[i] |= (slight | self.met) & stall;
            let ends = self.rounding[i] || d <= least || is_settled(kind, tolerance, x, d, last);
            let open = !(ends || (kind.is_simplified() && self.is_gone(i, d)));
            settled &= !open;
            stalls |= open & stall;
        }
        // If the next correction is predicted to be round-off in all components, components that have not converged never will.
        settled |=
            kind == CorrectionKind::Chord && step <= BLIND * size && step * (step / before).min(1.0) <= UNBIASED * size;
        // Whoever goes on after the first correction with a frozen Jacobian has seen that the equations are not met.
        settled &= kind != CorrectionKind::Frozen || iteration > 1;
        self.watched &= !contracts;
        let stuck = (stalls && step >= STALL * before) || iteration >= limit;
        if !contracts || (stuck && !(settled || slight || self.met)) {
            let most = roundings();
            let within = |bound: f64| most.map_or(step <= BLIND * size, |most| most <= bound);
            // If the linear equations cannot be refined, their round-off counts too.
            let chord = kind == CorrectionKind::Chord;
            let met = within(if chord || !refinable { OF_CORRECTION } else { ROUNDINGS });
            self.met |= met;
            self.unmet = !met;
            // Corrections with less round-off may yet show contraction.
            self.watched = !contracts && !met && refinable;
            self.certain &= contracts || within(NEAR_ROUNDINGS) || refinable;
            if met && !settled {
                settled = self.stalled(correction) || kind == CorrectionKind::Chord || iteration >= limit;
            }
        }
        for (last, d) in self.last.iter_mut().zip(correction) {
            *last = d.abs();
        }
        self.watched |= iteration == 1;
        self.before = step;
        if settled {
            return Ok(true);
        }
        // The corrections themselves are compared: relative to unknowns that shrink they may grow and yet converge.
        // Corrections that move the place by its rounding only lead nowhere else, however they grow.
        self.growths += u32::from(step > before && step > near && !slight && !self.met);
        let (correction, history) = (step / size, self.history());
        if self.growths == GROWTHS {
            return Err(NewtonError::Diverged { iteration, correction, before: before / size, history });
        }
        if iteration >= limit {
            return Err(NewtonError::IterationLimit { iterations: iteration, correction, history });
        }
        Ok(false)
    }

    /// Whether simplified corrections have taken a component to zero.
    #[inline(always)]
    fn is_gone(&self, i: usize, d: f64) -> bool {
        let start = self.start[i].abs();
        d <= GONE * if start == 0.0 { self.size } else { start }
    }

    /// Marks the components that stall as moving by round-off; returns whether all components have then converged.
    #[cold]
    fn stalled(&mut self, correction: &[f64]) -> bool {
        let mut all = true;
        for ((d, last), rounding) in correction.iter().zip(&*self.last).zip(&mut *self.rounding) {
            *rounding |= d.abs() >= STALL * last;
            all &= *rounding;
        }
        all
    }
}

/// Whether a component of the size `x` has converged with its correction `d` after `last`: by that correction, or by the predicted next
/// one. A correction larger than the component that it leaves brings round-off of its own, and predicts nothing.
#[inline(always)]
fn is_settled(kind: CorrectionKind, tolerance: f64, x: f64, d: f64, last: f64) -> bool {
    let shrink = d / last;
    let (next, least) = match kind {
        CorrectionKind::Newton => (d * (shrink * shrink), tolerance),
        CorrectionKind::Simplified => (d * (2.0 * shrink), tolerance),
        CorrectionKind::Frozen => (d * (2.0 * shrink), UNBIASED),
        CorrectionKind::Chord => (d * shrink, UNBIASED),
    };
    let predicts = last.is_finite() && d <= x;
    d <= tolerance * x || (predicts && next <= least * x)
}
