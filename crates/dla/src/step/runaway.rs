use crate::{ClosedStepError, RunError, StepError};

/// Detects, from runs with ever shorter steps, a motion that itself leaves the range of numbers, which no step prevents.
#[derive(Debug, Clone, Copy, Default)]
pub struct Runaway {
    /// The time at which the last run failed (s).
    last: Option<f64>,
    /// Number of runs in a row that agree with the one before.
    agree: u32,
}

impl Runaway {
    /// Number of agreeing runs that is enough.
    const ENOUGH: u32 = 2;
    /// Largest difference of the times of failure of runs that agree, in steps of the present run.
    const STEPS: f64 = 8.0;

    /// Whether the failures so far and this one, of a run with the step `step` (s), show such a motion: their numbers are not finite from
    /// the same time on, after more than `fine` steps.
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
