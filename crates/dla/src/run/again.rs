use super::substeps::{LastReport, substepped_part};
use crate::{AnyState, Mechanism, Method, Report, Schedule, StepError};

/// A step of a method by itself, without the memory of other steps, as a run of its own; with its work if that is asked for.
///
/// It uses the code of whole runs, and makes the method each time: for the few steps between nodes.
///
/// # Errors
/// [`StepError`] if the step has no solution; the state is then unchanged.
pub fn again(
    system: &dyn Mechanism,
    method: &Method,
    (t, h): (f64, f64),
    state: &mut AnyState,
    work: bool,
) -> Result<Report, StepError> {
    let mut last = LastReport { report: Report::default(), work };
    let schedule = Schedule { t0: t, step: h, steps: 1 };
    let mut integrator = system.integrator(method);
    let part = substepped_part(system, &mut *integrator, method.substeps(), &schedule, 0..1, state, &mut last)
        .map_err(|error| error.source)?;
    if part.made == 1 { Ok(last.report) } else { Err(StepError::Stopped) }
}
