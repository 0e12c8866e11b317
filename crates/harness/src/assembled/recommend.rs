use super::pieces::{AssemblyPieces, PieceStep};
use crate::Method;
use assembly::{Assembly, AssemblyError, AssemblyRunError, AssemblyState};
use dla::{RecommendError, Recommendation, RunError, recommend_by_trial};

/// The longest step of a whole run of an assembly from time zero with which some of its coordinates meet a tolerance: see
/// [`dla::recommend_step`]. `seen` chooses the coordinates.
///
/// # Errors
/// [`RecommendError`], with the best that is within reach.
pub fn recommend_assembly<const N: usize>(
    assembly: &Assembly,
    method: &Method,
    start: &AssemblyState,
    duration: f64,
    tolerance: f64,
    seen: impl Fn(&AssemblyState) -> [f64; N],
) -> Result<Recommendation, RecommendError> {
    let seen = |state: &AssemblyState| dla::State::new(seen(state), [0.0; N], [false; N]);
    recommend_by_trial(duration, tolerance, |schedule, times| {
        let of_run = |AssemblyRunError { step, time, source }| RunError { step, time, source: source.step_error() };
        let mut pieces = AssemblyPieces::new(assembly, method, schedule).map_err(of_run)?;
        let (mut state, mut taken) = (start.clone(), Vec::new());
        let mut times = times.iter().peekable();
        for k in 0..schedule.steps {
            let PieceStep { assembly, stepper, time: (t0, h), end } = pieces.step(k, &mut state).map_err(of_run)?;
            let failed = |source: AssemblyError| RunError { step: k + 1, time: t0, source: source.step_error() };
            // Between nodes by a shorter step from the one before.
            while let Some(t) = times.next_if(|t| **t < end) {
                let mut between = state.clone();
                if *t > t0 {
                    stepper.step(assembly, t0, t - t0, &mut between).map_err(failed)?;
                }
                taken.push(seen(&between));
            }
            stepper.step(assembly, t0, h, &mut state).map_err(failed)?;
        }
        taken.extend(times.map(|_| seen(&state)));
        Ok(taken)
    })
}
