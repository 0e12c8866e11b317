use super::tolerances::{
    BLIND, CONTRACTION, GONE, GROWTHS, NEAR_ROUNDINGS, OF_CORRECTION, ROUNDINGS, STALL, UNBIASED, is_slight,
};
use crate::{History, NewtonError};
use lagrangian::linear::largest;

/// How corrections follow one another, by which the next one is known before it is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// With the derivatives of the point itself: with `w` the bound on the curvature, a correction `d` leaves `w d^2/2`.
    Newton,
    /// With those of the point before: the first is `d = w d_before^2/2`, and leaves `w d_before d`.
    Simplified,
    /// With those of a step before, which are kept: each shrinks by the same factor. Of thousands of components, some of which
    /// would always shrink a little, what is rounding beside the largest counts as settled.
    Chord,
}

/// What a search asks of every correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// How the correction was made.
    pub kind: Kind,
    /// Relative tolerance of every component.
    pub tolerance: f64,
    /// Corrections after which the search is given up.
    pub limit: u32,
    /// Whether corrections can still be made with less rounding than they are.
    pub refinable: bool,
    /// A correction below this leads to no other solution: it moves the place of the step by its rounding only
    /// ([`rounding_of_place`]).
    pub near: f64,
}

/// The velocity that in a step of length `h` moves the configuration `q` by its rounding only: what corrects a constraint on positions by
/// the last digits of these is no less, however slow the motion is.
#[must_use]
#[inline(always)]
pub fn rounding_of_place(q: &[f64], h: f64) -> f64 {
    NEAR_ROUNDINGS * 0.5 * f64::EPSILON * largest(q) / h.abs()
}

/// The test of a search by corrections: Newton's method, with any of its approximations, on any number of unknowns.
///
/// A component is settled when its correction is below the tolerance relative to it, or the next one is predicted to be; or when
/// it no longer shrinks and the residuals of all equations are rounding of their terms; or when simplified corrections take it to
/// zero.
#[derive(Debug)]
pub struct Convergence<'a> {
    /// The last corrections of the components.
    last: &'a mut [f64],
    /// The components that have been seen to move by rounding only.
    rounding: &'a mut [bool],
    /// The components at the start: one that goes to zero is known by them.
    start: &'a [f64],
    /// The largest component so far, the start's too: a solution of zeros only has no size of its own.
    size: f64,
    before: f64,
    growths: u32,
    history: History,
    first: f64,
    /// Whether the next correction is to show that the search contracts.
    watched: bool,
    certain: bool,
    /// Whether the residuals have been seen to be rounding.
    met: bool,
    /// Whether corrections stall whose residuals are not.
    unmet: bool,
    made: u32,
}

impl<'a> Convergence<'a> {
    /// A search that begins at `start`, with memory for as many components.
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

    /// Whether the search contracted from its start, so that what it found is the solution near there.
    #[inline(always)]
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.certain
    }

    /// Whether corrections stall though the residuals are not rounding: what is left is the rounding of the corrections.
    #[inline(always)]
    #[must_use]
    pub fn is_unmet(&self) -> bool {
        self.unmet
    }

    /// Looks at a correction that leads to `x`, and says whether every component is settled. `roundings` tells how many
    /// roundings of their terms the residuals are where the correction was made, at most; none where the equations do not know.
    ///
    /// # Errors
    /// [`NewtonError`] where the search leads nowhere.
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
        let contracts = !self.watched || slight || step <= near || step <= CONTRACTION * before;
        let least = if kind == Kind::Chord { tolerance * size } else { 0.0 };
        let [mut settled, mut stalls] = [true, false];
        for i in 0..x.len() {
            let (d, x, last) = (correction[i].abs(), x[i].abs(), self.last[i]);
            let stall = d >= STALL * last;
            // Once a component has been seen to move by rounding only, it stays so.
            self.rounding[i] |= (slight | self.met) & stall;
            let ends = self.rounding[i] || d <= least || is_settled(kind, tolerance, x, d, last);
            let open = !(ends || (kind == Kind::Simplified && self.is_gone(i, d)));
            settled &= !open;
            stalls |= open & stall;
        }
        // Where the next correction is predicted to be rounding in all components, those that have not settled never will.
        settled |= kind == Kind::Chord && step <= BLIND * size && step * (step / before).min(1.0) <= UNBIASED * size;
        self.watched &= !contracts;
        let stuck = (stalls && step >= STALL * before) || iteration >= limit;
        if !contracts || (stuck && !(settled || slight || self.met)) {
            let most = roundings();
            let within = |bound: f64| most.map_or(step <= BLIND * size, |most| most <= bound);
            // Where nothing more can be done about the rounding of corrections, that counts too.
            let chord = kind == Kind::Chord;
            let met = within(if chord || !refinable { OF_CORRECTION } else { ROUNDINGS });
            self.met |= met;
            self.unmet = !met;
            // By corrections with less rounding it may yet be seen.
            self.watched = !contracts && !met && refinable;
            self.certain &= contracts || within(NEAR_ROUNDINGS) || refinable;
            if met && !settled {
                settled = self.stalled(correction) || kind == Kind::Chord || iteration >= limit;
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
        self.growths += u32::from(step > before && !slight && !self.met);
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

    /// That the components that stall move by rounding only; whether all do, or have settled in another way.
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

/// Whether a component of the size `x` is settled by its correction `d` after `last`: by that, or by the next one as it is
/// predicted. A correction larger than what it leaves brings rounding of its own, and predicts nothing.
#[inline(always)]
pub(crate) fn is_settled(kind: Kind, tolerance: f64, x: f64, d: f64, last: f64) -> bool {
    let shrink = d / last;
    let (next, least) = match kind {
        Kind::Newton => (d * (shrink * shrink), tolerance),
        Kind::Simplified => (d * (2.0 * shrink), tolerance),
        Kind::Chord => (d * shrink, UNBIASED),
    };
    let predicts = last.is_finite() && d <= x;
    d <= tolerance * x || (predicts && next <= least * x)
}
