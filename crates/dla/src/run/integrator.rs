use crate::{AnyState, Mechanics, OneStep, State, StepError, StepReport};
use lagrangian::PowerSources;
use std::ops::ControlFlow;

/// A method made for a system: moves states of it, step by step. Sizes are known at run time.
pub trait Integrator {
    /// Moves the state from time `t` to `t + h` (s).
    ///
    /// # Errors
    /// [`StepError`] if the step has no solution that the method accepts; the state is then unchanged.
    fn step(&mut self, t: f64, h: f64, state: &mut AnyState) -> Result<&Report, StepError>;

    /// As [`OneStep::memory`].
    fn memory(&self) -> Vec<f64>;

    /// As [`OneStep::recall`].
    fn recall(&mut self, memory: &[f64], state: &AnyState);

    /// As [`OneStep::measure_work`].
    fn measure_work(&mut self, sources: PowerSources);

    /// As [`OneStep::own_steps`].
    ///
    /// # Errors
    /// As [`step`](Self::step), after what was shown until then.
    fn own_steps(
        &self,
        time: (f64, f64),
        state: &AnyState,
        memory: &mut Vec<f64>,
        see: &mut SeeOwnStep<'_>,
    ) -> Result<(), StepError>;
}

/// Looks at the end of a step that a method makes of its own, a time (s) and a state; `Break` asks for no more of them.
pub type SeeOwnStep<'a> = dyn FnMut(f64, &AnyState) -> ControlFlow<()> + 'a;

/// The report of a step, besides the state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Impulses of the constraints at the two ends of the step (N s), as in [`StepReport::impulses`].
    pub impulses: [Vec<f64>; 2],
    /// Newton iterations of the step's equations; 0 for an explicit method.
    pub iterations: u32,
    /// The work that was done over the step (J), of a method that reports one.
    pub work: Option<f64>,
    /// As [`StepReport::rounding`].
    pub rounding: f64,
}

impl Report {
    /// The report of a step of `rows` constraints of which nothing is known.
    #[must_use]
    pub fn of(rows: usize) -> Self {
        Self { impulses: [vec![0.0; rows], vec![0.0; rows]], iterations: 0, work: None, rounding: 0.0 }
    }

    /// Adds what a further step did.
    pub fn add(&mut self, next: &Self) {
        for (sum, impulses) in self.impulses.iter_mut().zip(&next.impulses) {
            sum.iter_mut().zip(impulses).for_each(|(sum, impulse)| *sum += impulse);
        }
        self.iterations += next.iterations;
        self.rounding = self.rounding.max(next.rounding);
        self.work = match (self.work, next.work) {
            (Some(before), Some(work)) => Some(before + work),
            (before, work) => before.or(work),
        };
    }

    /// Writes the constraint forces, averaged over a step of length `h`: second-order accurate in its middle.
    pub fn multipliers_into(&self, h: f64, multipliers: &mut [f64]) {
        let [before, after] = &self.impulses;
        let both = before.iter().zip(after);
        multipliers.iter_mut().zip(both).for_each(|(lambda, (before, after))| *lambda = (before + after) / h);
    }

    /// The constraint forces as a list.
    #[must_use]
    pub fn multipliers(&self, h: f64) -> Vec<f64> {
        let mut multipliers = vec![0.0; self.impulses[0].len()];
        self.multipliers_into(h, &mut multipliers);
        multipliers
    }

    /// The report of a step of a shape.
    pub(crate) fn typed<const M: usize>(&self) -> StepReport<M> {
        let impulses = [super::state::row(&self.impulses[0]), super::state::row(&self.impulses[1])];
        StepReport { impulses, iterations: self.iterations, work: self.work, rounding: self.rounding }
    }

    #[inline]
    fn take<const M: usize>(&mut self, report: &StepReport<M>) {
        for (own, impulses) in self.impulses.iter_mut().zip(&report.impulses) {
            own.copy_from_slice(impulses);
        }
        (self.iterations, self.work, self.rounding) = (report.iterations, report.work, report.rounding);
    }
}

impl<const M: usize> From<&StepReport<M>> for Report {
    fn from(report: &StepReport<M>) -> Self {
        let mut own = Self::of(M);
        own.take(report);
        own
    }
}

/// A method of a shape, with the system that it steps.
pub(crate) struct Bound<'a, Method, const N: usize, const M: usize> {
    system: &'a dyn Mechanics<N, M>,
    method: Method,
    report: Report,
}

impl<'a, Method, const N: usize, const M: usize> Bound<'a, Method, N, M> {
    pub(crate) fn new(system: &'a dyn Mechanics<N, M>, method: Method) -> Self {
        Self { system, method, report: Report::of(M) }
    }
}

impl<Method: OneStep<N, M>, const N: usize, const M: usize> Integrator for Bound<'_, Method, N, M> {
    #[inline]
    fn step(&mut self, t: f64, h: f64, state: &mut AnyState) -> Result<&Report, StepError> {
        let state = state.typed_mut::<N>().ok_or(StepError::OTHER_SHAPE)?;
        let report = self.method.step(self.system, t, h, state)?;
        self.report.take(&report);
        Ok(&self.report)
    }

    fn memory(&self) -> Vec<f64> {
        self.method.memory()
    }

    fn recall(&mut self, memory: &[f64], state: &AnyState) {
        if let Some(state) = state.typed() {
            self.method.recall(memory, state);
        }
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.method.measure_work(sources);
    }

    fn own_steps(
        &self,
        time: (f64, f64),
        state: &AnyState,
        memory: &mut Vec<f64>,
        see: &mut SeeOwnStep<'_>,
    ) -> Result<(), StepError> {
        let start = state.typed::<N>().ok_or(StepError::OTHER_SHAPE)?;
        let mut shown = state.clone();
        self.method.own_steps(self.system, time, start, memory, &mut |t, node: &State<N>| {
            if let Some(shown) = shown.typed_mut() {
                *shown = *node;
            }
            see(t, &shown)
        })
    }
}
