use super::samples::states_at;
use crate::Method;
use assembly::{Assembly, AssemblyRunError, AssemblyState};
use dla::{RecommendError, Recommendation, RunError, recommend_by_trial};

/// The longest step of a whole run of an assembly from time zero with which some of its coordinates meet a tolerance: see
/// [`dla::recommend_by_trial`]. `seen` chooses the coordinates.
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
    recommend_by_trial(duration, tolerance, |schedule, times| {
        let mut taken = Vec::new();
        let of_run = |AssemblyRunError { step, time, source }| RunError::new(step, time, source.step_error());
        states_at(assembly, method, schedule, start, times, |_, _, state| taken.push(seen(state).to_vec()))
            .map_err(of_run)?;
        Ok(taken)
    })
}
