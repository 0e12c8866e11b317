use crate::{Method, Run};
use dla::{Mechanism, RunError, Schedule, StepError, pieces};

/// A motion to be computed again and again, with other methods and other steps.
#[derive(Debug, Clone)]
pub struct ReferenceMotion<'a> {
    system: &'a dyn Mechanism,
    q: Vec<f64>,
    v: Vec<f64>,
    duration: f64,
    base: u64,
    /// Least number of steps, one for each piece between jumps.
    least: u64,
}

/// Number of steps of the coarsest run.
const FEWEST: u64 = 8;
/// Largest number of equal steps that is tried so that every jump falls on a node.
const MOST: u64 = 1 << 20;

impl<'a> ReferenceMotion<'a> {
    /// The motion of a system from `q` with the velocity `v` over `duration` (s).
    #[must_use]
    pub fn new(system: &'a dyn Mechanism, q: &[f64], v: &[f64], duration: f64) -> Self {
        let jumps = system.jump_times(0.0, duration);
        let motion = Self { system, q: q.to_vec(), v: v.to_vec(), duration, base: 1, least: 1 + jumps.len() as u64 };
        let aligned = |steps: &u64| pieces(&motion.schedule(*steps), jumps.clone()).is_ok();
        let base = (1..=MOST).find(aligned).unwrap_or(1);
        Self { base, ..motion }
    }

    /// The duration of the motion (s).
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The steps of the coarsest run.
    #[must_use]
    pub fn fewest(&self) -> u64 {
        self.aligned(FEWEST)
    }

    /// The first number of steps from the given one on with which every jump of the system falls on a node of equal steps; if no usual
    /// number does, the first that the pieces between jumps can share.
    #[must_use]
    pub fn aligned(&self, steps: u64) -> u64 {
        steps.max(self.least).div_ceil(self.base).saturating_mul(self.base)
    }

    fn schedule(&self, steps: u64) -> Schedule {
        Schedule { t0: 0.0, step: self.duration / steps as f64, steps }
    }

    /// The configuration at the end of the motion with `steps` steps of a method.
    ///
    /// # Errors
    /// [`RunError`] with the step that failed.
    pub fn end(&self, method: &Method, steps: u64) -> Result<Vec<f64>, RunError> {
        let mut state = self.system.state(&self.q, &self.v);
        let made = Run::of(self.system, method).moves(&self.schedule(steps), &mut state)?;
        if made < steps {
            let time = self.schedule(steps).time(made);
            return Err(RunError::new(made + 1, time, StepError::Stopped));
        }
        Ok(state.unwrapped())
    }
}
