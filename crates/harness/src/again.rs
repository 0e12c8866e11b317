use crate::substeps::substepped_part;
use crate::{Dop853, Kind, Method};
use dla::{Observer, OneStep, OwnStep, Schedule, State, StepError, StepReport, View};
use lagrangian::System;
use std::ops::ControlFlow;

/// A method by its name, as a map of one step: every step is a run of its own, without what the method remembers of others.
///
/// It uses the code of whole runs, and makes the method anew each time: for the few steps between nodes.
#[derive(Debug, Clone, Copy)]
pub struct Again<'a>(pub &'a Method);

/// What the last step reported.
pub(crate) struct Report<const M: usize>(pub(crate) StepReport<M>);

impl<Sys, const N: usize, const M: usize> Observer<Sys, N, M> for Report<M> {
    fn start(&mut self, _node: &View<'_, Sys, N>) {}

    fn step(&mut self, _node: &View<'_, Sys, N>, report: &StepReport<M>) -> ControlFlow<()> {
        self.0 = *report;
        ControlFlow::Continue(())
    }
}

impl<Sys: System<N, M>, const N: usize, const M: usize> OneStep<Sys, N, M> for Again<'_> {
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<N>) -> Result<StepReport<M>, StepError> {
        let mut report = Report(StepReport::of(0));
        let observer: &mut dyn Observer<Sys, N, M> = &mut report;
        let schedule = Schedule { t0: t, step: h, steps: 1 };
        substepped_part(system, self.0, &schedule, 0..1, state, observer, None).map_err(|error| error.source)?;
        Ok(report.0)
    }

    /// Of the one method in the table that has any.
    fn own_steps(
        &self,
        system: &Sys,
        step: (f64, f64),
        state: &State<N>,
        memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        match self.0.info().kind {
            Kind::Dop853 => Dop853::<N, M>::new(self.0.tolerance()).own_steps(system, step, state, memory, see),
            _ => Ok(()),
        }
    }
}
