use super::assembly_method;
use crate::Method;
use assembly::{Assembly, AssemblyState};
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
        let failed = |k: u64, source: assembly::AssemblyError| RunError {
            step: k + 1,
            time: schedule.time(k),
            source: source.step_error(),
        };
        let mut method = assembly_method(assembly, method).map_err(|source| failed(0, source))?;
        let (mut state, mut taken) = (start.clone(), Vec::new());
        let mut times = times.iter().peekable();
        for k in 0..schedule.steps {
            let (t0, t1) = (schedule.time(k), schedule.time(k + 1));
            // Between nodes by a shorter step from the one before.
            while let Some(t) = times.next_if(|t| **t < t1) {
                let mut between = state.clone();
                if *t > t0 {
                    method.step(assembly, t0, t - t0, &mut between).map_err(|source| failed(k, source))?;
                }
                taken.push(seen(&between));
            }
            method.step(assembly, t0, schedule.step, &mut state).map_err(|source| failed(k, source))?;
        }
        taken.extend(times.map(|_| seen(&state)));
        Ok(taken)
    })
}
