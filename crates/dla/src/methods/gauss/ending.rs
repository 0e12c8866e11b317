use crate::convergence::tolerances::{SLOWEST, STALL_OF_FIXED_POINT};
use lagrangian::linear::larger;

/// The convergence test of a fixed-point iteration in registers, on changes relative to a unit for each component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ending {
    /// The largest next change, as estimated, with which the iteration has converged.
    pub(super) left: f64,
    /// Changes below this that stall twice are round-off.
    pub(super) rounding: f64,
    /// Changes below this that stall once are round-off.
    pub(super) noise: f64,
    /// Iterations after which the step fails.
    pub(super) limit: u32,
    /// An iteration whose contraction factor is above this does not converge.
    pub(super) hopeless: f64,
    /// Iterations that are made without a test, if there is a predictor.
    pub(super) untested: u32,
}

/// An iteration under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct StageSearch {
    ending: Ending,
    pub(super) iterations: u32,
    /// The last change, and its ratio to the one before.
    last: f64,
    rate: f64,
    /// The contraction factor: the last ratio of changes above round-off; zero if there was none, as in a motion whose slopes are constant.
    pub(super) contraction: f64,
    /// How many small changes have stalled.
    stalled: u32,
}

/// The consequence of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EndingVerdict {
    Continue,
    Done,
    Failed,
}

impl Ending {
    /// An iteration that starts at the predictor of the last step, or without one.
    #[inline(always)]
    pub(super) fn begin(self, led: bool) -> StageSearch {
        // The count may come from a file: the limit holds all the same.
        let untested = if led { self.untested } else { ANEW }.min(self.limit.saturating_sub(1));
        StageSearch {
            ending: Self { untested, ..self },
            iterations: 0,
            last: f64::INFINITY,
            rate: 1.0,
            contraction: 0.0,
            stalled: 0,
        }
    }
}

impl StageSearch {
    /// Counts an iteration; returns true if it has no test.
    #[inline(always)]
    pub(super) fn next_is_untested(&mut self) -> bool {
        self.iterations += 1;
        self.iterations <= self.ending.untested
    }

    /// Tests the largest change of an iteration.
    #[inline(always)]
    pub(super) fn look(&mut self, moved: f64) -> EndingVerdict {
        let Ending { left, rounding, noise, limit, hopeless, untested } = self.ending;
        let seen = self.iterations - untested;
        let (slower, now) = (if seen > 2 { self.rate } else { 0.0 }, moved / self.last);
        self.rate = if seen > 1 { now } else { self.rate };
        // From a good predictor the first iterations may contract faster than the later ones.
        let expected = larger(larger(self.rate, slower), SLOWEST);
        let settled = seen > 1 && self.rate < 1.0 && moved * expected <= left * (1.0 - self.rate);
        // One stall may be an iteration that rotates the error before it shrinks. The two stalls need not follow one another: round-off may
        // shrink in between, and grow again.
        let small = moved <= rounding;
        let stalls = small && moved >= STALL_OF_FIXED_POINT * self.last;
        self.stalled += u32::from(stalls);
        if seen > 1 && !stalls {
            self.contraction = now;
        }
        if moved == 0.0 || settled || (stalls && (self.stalled > 1 || moved <= noise)) {
            return EndingVerdict::Done;
        }
        let grows = seen > 3 && self.rate > hopeless && !small;
        self.last = moved;
        if moved.is_nan() || moved.is_infinite() || grows || self.iterations >= limit {
            EndingVerdict::Failed
        } else {
            EndingVerdict::Continue
        }
    }
}

/// Iterations without a test if there is no predictor: slopes that are not zero in the end may be zero at first, and give no unit for
/// changes.
const ANEW: u32 = 3;

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::convergence::tolerances::{LEFT, NOISE, OF_ROW};

    const ENDING: Ending =
        Ending { left: LEFT, rounding: OF_ROW, noise: NOISE, limit: 100, hopeless: 2.0, untested: 12 };

    /// The verdict after these changes, one after the other, and after how many of them it was reached.
    fn search(changes: &[f64]) -> (usize, EndingVerdict) {
        let mut search = ENDING.begin(true);
        while search.next_is_untested() {}
        for (seen, &moved) in (1..).zip(changes) {
            match search.look(moved) {
                EndingVerdict::Continue => search.iterations += 1,
                verdict => return (seen, verdict),
            }
        }
        (changes.len(), EndingVerdict::Continue)
    }

    /// Round-off that shrinks in between and grows again is convergence all the same.
    #[test]
    fn rounding_may_go_round() {
        assert_eq!(
            search(&[4.5e-14, 2.1e-14, 5.1e-15, 2.2e-15, 6.2e-16, 3.0e-15, 3.1e-16, 3.2e-15]),
            (8, EndingVerdict::Done)
        );
        assert_eq!(search(&[3e-16, 2.2e-16]), (2, EndingVerdict::Done));
        // One stall above the noise may be an iteration that rotates the error.
        assert_eq!(search(&[1e-14, 8e-15, 1e-15, 1e-16]), (4, EndingVerdict::Continue));
    }

    /// Round-off does not contract, and says nothing of how fast the iteration does: nor does a first change that is nothing.
    #[test]
    fn rounding_tells_no_contraction() {
        let contraction = |changes: &[f64]| {
            let mut search = ENDING.begin(true);
            while search.next_is_untested() {}
            for &moved in changes {
                search.look(moved);
                search.iterations += 1;
            }
            search.contraction
        };
        assert_eq!([contraction(&[0.0]), contraction(&[2e-16, 2e-16])], [0.0; 2]);
        assert!((contraction(&[1e-3, 1e-5]) - 1e-2).abs() < 1e-15);
        assert!((contraction(&[1e-12, 1e-14, 1e-14]) - 1e-2).abs() < 1e-15);
    }

    /// Changes that grow above round-off do not converge, nor does NaN.
    #[test]
    fn growth_is_failure() {
        assert_eq!(search(&[1e-3, 1e-4, 1e-5, 3e-5]), (4, EndingVerdict::Failed));
        assert_eq!(search(&[1e-3, f64::NAN]), (2, EndingVerdict::Failed));
    }

    /// An iteration has converged when the estimated next change is small enough, and not before two changes gave the estimate.
    #[test]
    fn the_rate_tells_what_is_to_come() {
        assert_eq!(search(&[1e-18]), (1, EndingVerdict::Continue));
        assert_eq!(search(&[1e-13, 1e-16]), (2, EndingVerdict::Done));
        assert_eq!(search(&[1e-9, 1e-12]), (2, EndingVerdict::Continue));
    }

    /// Without a predictor the first iterations have no test; every iteration has one in the end.
    #[test]
    fn some_are_not_looked_at() {
        assert_eq!((ENDING.begin(false).ending.untested, ENDING.begin(true).ending.untested), (ANEW, 12));
        assert_eq!(Ending { limit: 5, ..ENDING }.begin(true).ending.untested, 4);
        assert_eq!(Ending { limit: 0, ..ENDING }.begin(false).ending.untested, 0);
    }
}
