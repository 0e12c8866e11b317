use crate::{Method, integrate_pieces};
use dla::{RunError, Schedule, State, StepError, Subject, pieces};

/// A motion to be computed again and again, with other methods and other steps.
#[derive(Debug, Clone, Copy)]
pub struct ReferenceMotion<'a, const N: usize, const M: usize> {
    subject: Subject<'a, N, M>,
    q: [f64; N],
    v: [f64; N],
    duration: f64,
    base: u64,
    /// The least that the pieces between jumps need.
    least: u64,
}

/// The coarsest run has so many steps.
const FEWEST: u64 = 8;
/// More steps than so many are not asked for so that every jump falls on a node of equal steps.
const MOST: u64 = 1 << 20;

impl<'a, const N: usize, const M: usize> ReferenceMotion<'a, N, M> {
    /// The motion of a system from `q` with the velocity `v` over `duration` (s).
    #[must_use]
    pub fn new(subject: impl Into<Subject<'a, N, M>>, q: [f64; N], v: [f64; N], duration: f64) -> Self {
        let subject = subject.into();
        let jumps = subject.system.jump_times(0.0, duration);
        let motion = Self { subject, q, v, duration, base: 1, least: 1 + jumps.len() as u64 };
        let aligned = |steps: &u64| pieces(&motion.schedule(*steps), jumps.clone()).is_ok();
        Self { base: (1..=MOST).find(aligned).unwrap_or(1), ..motion }
    }

    /// How long it takes (s).
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The steps of the coarsest run.
    #[must_use]
    pub fn fewest(&self) -> u64 {
        self.aligned(FEWEST)
    }

    /// The first number of steps from the given one on with which every jump of the system falls on a node of equal steps; or, where no
    /// usual number does, that the pieces between jumps can share.
    #[must_use]
    pub fn aligned(&self, steps: u64) -> u64 {
        steps.max(self.least).div_ceil(self.base).saturating_mul(self.base)
    }

    fn schedule(&self, steps: u64) -> Schedule {
        Schedule { t0: 0.0, step: self.duration / steps as f64, steps }
    }

    /// Where the motion ends with that many steps of a method.
    ///
    /// # Errors
    /// [`RunError`] with the step that failed.
    #[inline(never)]
    pub fn end(&self, method: &Method, steps: u64) -> Result<[f64; N], RunError> {
        let mut state = State::new(self.q, self.v, self.subject.system.angles());
        let made = integrate_pieces(self.subject, method, &self.schedule(steps), &mut state, &mut ())?;
        if made < steps {
            let time = self.schedule(steps).time(made);
            return Err(RunError::new(made + 1, time, StepError::Stopped));
        }
        Ok(state.unwrapped())
    }
}
