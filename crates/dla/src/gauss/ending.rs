use lagrangian::linear::larger;

/// When an iteration has come to its end, by changes in units of what they count.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ending {
    /// What the next change may still be.
    pub(super) left: f64,
    /// Changes below which shrink no more, twice, are rounding.
    pub(super) rounding: f64,
    /// And once.
    pub(super) noise: f64,
    /// Iterations after which the search is given up.
    pub(super) limit: u32,
    /// Changes that shrink by no more than this do not converge.
    pub(super) hopeless: f64,
    /// Iterations that are made before any is looked at, where there was a step before.
    pub(super) unseen: u32,
}

/// A search under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    ending: Ending,
    pub(super) iterations: u32,
    /// The last change, and by how much it shrank.
    last: f64,
    pub(super) rate: f64,
    stalled: u32,
}

/// What a change says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    Continue,
    Done,
    Failed,
}

impl Ending {
    /// A search that begins where a step before leads, or anew.
    #[inline(always)]
    pub(super) fn begin(self, led: bool) -> Search {
        // What is remembered may come from a file: the limit holds all the same.
        let unseen = if led { self.unseen.min(self.limit.saturating_sub(1)) } else { 0 };
        Search { ending: Self { unseen, ..self }, iterations: 0, last: f64::INFINITY, rate: 1.0, stalled: 0 }
    }
}

impl Search {
    /// Counts an iteration; whether nobody looks at it.
    #[inline(always)]
    pub(super) fn next_is_unseen(&mut self) -> bool {
        self.iterations += 1;
        self.iterations <= self.ending.unseen
    }

    /// Looks at the largest change of an iteration.
    #[inline(always)]
    pub(super) fn look(&mut self, moved: f64) -> Verdict {
        let Ending { left, rounding, noise, limit, hopeless, unseen } = self.ending;
        let seen = self.iterations - unseen;
        let (slower, now) = (if seen > 2 { self.rate } else { 0.0 }, moved / self.last);
        self.rate = if seen > 1 { now } else { self.rate };
        // A search that begins near its end may shrink faster at first than it goes on.
        let expected = larger(larger(self.rate, slower), SLOWEST);
        let settled = seen > 1 && self.rate < 1.0 && moved * expected <= left * (1.0 - self.rate);
        // Once may be an iteration that turns the error round before it shrinks.
        self.stalled = if moved >= 0.5 * self.last { self.stalled + 1 } else { 0 };
        let rounding = (self.stalled > 1 && moved <= rounding) || (self.stalled > 0 && moved <= noise);
        if moved == 0.0 || settled || rounding {
            return Verdict::Done;
        }
        let grows = seen > 3 && self.rate > hopeless;
        self.last = moved;
        if moved.is_nan() || moved.is_infinite() || grows || self.iterations >= limit {
            Verdict::Failed
        } else {
            Verdict::Continue
        }
    }
}

/// No iteration is expected to shrink its changes by more.
pub(crate) const SLOWEST: f64 = 0.05;
