use super::methods::Impulse;
use super::{Differentiable, Sensitivity, SensitivityError, Tangent, TangentRunError};
use crate::{OneStep, Schedule, State, StepReport, onto_constraint};
use std::ops::ControlFlow;

impl<const N: usize, const M: usize, const P: usize> Sensitivity<'_, N, M, P> {
    /// Moves a state and tangents together from time `t` to `t + h`.
    ///
    /// # Errors
    /// As [`Sensitivity::step`]; state and tangents are then unchanged.
    pub fn advance<Method>(
        &self,
        method: &mut Method,
        t: f64,
        h: f64,
        state: &mut State<N>,
        tangents: &mut [Tangent<N, P>],
    ) -> Result<StepReport<M>, SensitivityError>
    where
        Method: OneStep<N, M> + Differentiable<N, M>,
    {
        let derivative = self.step(method, t, h, state)?;
        for tangent in tangents {
            *tangent = derivative.apply(tangent);
        }
        Ok(derivative.report)
    }

    /// Makes the steps of a schedule with a state and tangents; returns how many were made.
    ///
    /// After every step `each` sees the time (s) and the state, and may change the tangents: a computation of Lyapunov exponents makes them
    /// orthonormal. `Break` ends the run there. No matrix is kept.
    ///
    /// # Errors
    /// [`TangentRunError`] with the step that failed; state and tangents are then at the last good node.
    pub fn drive<Method>(
        &self,
        method: &mut Method,
        schedule: &Schedule,
        state: &mut State<N>,
        tangents: &mut [Tangent<N, P>],
        mut each: impl FnMut(f64, &State<N>, &mut [Tangent<N, P>]) -> ControlFlow<()>,
    ) -> Result<u64, TangentRunError>
    where
        Method: OneStep<N, M> + Differentiable<N, M>,
    {
        for k in 0..schedule.steps {
            let time = schedule.time(k);
            self.advance(method, time, schedule.step, state, tangents).map_err(|source| TangentRunError {
                step: k + 1,
                time,
                source,
            })?;
            if each(schedule.time(k + 1), state, tangents).is_break() {
                return Ok(k + 1);
            }
        }
        Ok(schedule.steps)
    }

    /// Brings a velocity onto the constraints as [`onto_constraint`] does, and tangents with it: what happens between two
    /// smooth pieces of a run, at a node that is fixed in time.
    ///
    /// # Errors
    /// As [`Sensitivity::step`]; state and tangents are then unchanged.
    pub fn onto_constraint(
        &self,
        t: f64,
        state: &mut State<N>,
        tangents: &mut [Tangent<N, P>],
    ) -> Result<(), SensitivityError> {
        let mut end = *state;
        onto_constraint(self.system(), t, &mut end)?;
        let derivative = self.between(&Impulse, (t, 0.0), state, &end, StepReport::of(0))?;
        *state = end;
        for tangent in tangents {
            *tangent = derivative.apply(tangent);
        }
        Ok(())
    }
}
