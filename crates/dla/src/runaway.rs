use crate::{ClosedStepError, RunError, StepError};

/// Looks at runs of one motion with ever shorter steps: whether the motion itself leaves the range of numbers, which no step prevents.
#[derive(Debug, Clone, Copy, Default)]
pub struct Runaway {
    /// When the last run failed (s).
    last: Option<f64>,
    /// How many runs in a row agree with the one before.
    agree: u32,
}

impl Runaway {
    /// So many runs that agree are enough.
    const ENOUGH: u32 = 2;
    /// They agree within so many steps of the longer kind.
    const STEPS: f64 = 8.0;

    /// Whether the failures so far and this one, of a run with that step (s), show it: their numbers are not finite from the same time on,
    /// after more than `fine` steps.
    pub fn sees(&mut self, error: &RunError, step: f64, fine: u64) -> bool {
        let late = is_beyond(&error.source) && error.step > fine;
        let same = self.last.is_some_and(|last| (last - error.time).abs() <= Self::STEPS * step.abs());
        self.agree = if late && same { self.agree + 1 } else { 0 };
        self.last = late.then_some(error.time);
        self.agree >= Self::ENOUGH
    }
}

/// Whether numbers of a step are not finite.
fn is_beyond(error: &StepError) -> bool {
    let named = matches!(error, StepError::Closed(ClosedStepError::NotFinite { .. }) | StepError::NotANumber(_));
    named || error.has_lost_numbers()
}
