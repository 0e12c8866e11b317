use super::AssemblyNode;
use super::pieces::{AssemblyPieces, PieceStep};
use crate::Method;
use assembly::{Assembly, AssemblyError, AssemblyRunError, AssemblyState};
use dla::{Schedule, stops};

/// Makes a run of an assembly, and shows its states at given times (s), in the order of the run: between nodes that of a shorter step from
/// the node before. Nothing is known of the work there.
///
/// # Errors
/// [`AssemblyRunError`] with the step that failed; the states before it have been shown.
pub fn sample_assembly(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    start: &AssemblyState,
    times: &[f64],
    sink: &mut dyn FnMut(&AssemblyNode),
) -> Result<(), AssemblyRunError> {
    states_at(assembly, method, schedule, start, times, |assembly, t, state| {
        sink(&AssemblyNode::of(assembly, (t, state), f64::NAN));
    })
}

/// The same with the state itself, and the smooth piece of the assembly. Times after the end have the state at the end.
pub(super) fn states_at(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    start: &AssemblyState,
    times: &[f64],
    mut take: impl FnMut(&Assembly, f64, &AssemblyState),
) -> Result<(), AssemblyRunError> {
    let mut pieces = AssemblyPieces::new(assembly, method, schedule)?;
    let (mut state, mut times) = (start.clone(), times.iter().copied().peekable());
    for k in 0..schedule.steps {
        if times.peek().is_none() {
            return Ok(());
        }
        let PieceStep { assembly, stepper, time: (t0, h), end } = pieces.step(k, &mut state)?;
        if stops() {
            return Err(AssemblyRunError { step: k + 1, time: t0, source: AssemblyError::Stopped });
        }
        let failed = |source| AssemblyRunError { step: k + 1, time: t0, source };
        while let Some(t) = times.next_if(|t| (end - t) * h > 0.0) {
            let mut between = state.clone();
            if (t - t0) * h > 0.0 {
                stepper.step(assembly, t0, t - t0, &mut between).map_err(failed)?;
            }
            take(assembly, t, &between);
        }
        stepper.step(assembly, t0, h, &mut state).map_err(failed)?;
    }
    times.for_each(|t| take(pieces.assembly(), t, &state));
    Ok(())
}
