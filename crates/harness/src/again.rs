use crate::Method;
use crate::substeps::{LastReport, substepped_part};
use dla::{Mechanics, OneStep, OwnMethods, OwnStep, Schedule, State, StepError, StepReport};

/// A method by its name, as a map of one step: every step is a run of its own, without the memory of other steps.
///
/// It uses the code of whole runs, and constructs the method each time: for the few steps between nodes.
#[derive(Clone, Copy)]
pub struct Again<'a, const N: usize, const M: usize> {
    /// The method.
    pub method: &'a Method,
    /// The integrators that the system brings of its own.
    pub own: &'a dyn OwnMethods<N, M>,
}

impl<const N: usize, const M: usize> std::fmt::Debug for Again<'_, N, M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Again").field(self.method).finish()
    }
}

impl<const N: usize, const M: usize> OneStep<N, M> for Again<'_, N, M> {
    #[inline(never)]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let mut report = LastReport(StepReport::of(0));
        let schedule = Schedule { t0: t, step: h, steps: 1 };
        let Self { method, own } = self;
        let (mut method, limits) = (method.stepper_of(*own, t + 0.5 * h), method.substeps());
        substepped_part(system, &mut *method, limits, &schedule, 0..1, state, &mut report)
            .map_err(|error| error.source)?;
        Ok(report.0)
    }

    /// Adaptive methods have some.
    fn own_steps(
        &self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &State<N>,
        memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        if !self.method.is_adaptive() {
            return Ok(());
        }
        let (t, h) = step;
        self.method.stepper_of(self.own, t + 0.5 * h).own_steps(system, step, state, memory, see)
    }
}
