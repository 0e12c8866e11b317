use crate::projection::Projection;
use crate::{Newton, RunError, Schedule, Stage, State, StepError};
use lagrangian::{System, constraint_residual, momentum};
use std::ops::Range;

/// A jump may miss a node by this part of a step, or by the rounding of its own time and of the step.
const ALIGNED: f64 = 1e-9;

/// Cuts a run into parts, the steps between one jump and the next.
///
/// `jumps` are times inside the run (s), in any order.
///
/// # Errors
/// [`RunError`] with [`StepError::Jump`] names the first jump that falls inside a step.
pub fn pieces(schedule: &Schedule, mut jumps: Vec<f64>) -> Result<Vec<Range<u64>>, RunError> {
    let order = schedule.step.signum();
    jumps.sort_by(|a, b| f64::total_cmp(&(order * a), &(order * b)));
    let mut parts = Vec::new();
    let mut begin = 0;
    for time in jumps {
        let steps = (time - schedule.t0) / schedule.step;
        let nearest = steps.round();
        if (steps - nearest).abs() > ALIGNED.max(8.0 * f64::EPSILON * nearest.abs()) {
            let step = steps.floor() as u64;
            return Err(RunError { step: step + 1, time: schedule.time(step), source: StepError::Jump { time } });
        }
        let end = (nearest as u64).min(schedule.steps);
        if end > begin {
            parts.push(begin..end);
            begin = end;
        }
    }
    if begin < schedule.steps || parts.is_empty() {
        parts.push(begin..schedule.steps);
    }
    Ok(parts)
}

/// Where a velocity misses its constraints by more than rounding, the impulse of the constraints brings it there: the
/// momentum is projected as at the end of a step, `L_v(q, v) = p + A' mu`, `A v + b = 0`.
///
/// # Errors
/// [`StepError::Newton`] where the constraints do not determine the velocity.
pub fn onto_constraint<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    state: &mut State<N>,
) -> Result<(), StepError> {
    let (q, v) = (*state.q(), *state.v());
    let residual = constraint_residual(system, t, &q, &v);
    let (a, b) = system.constraint(t, &q);
    let met = (0..M).all(|k| {
        let size = (0..N).fold(b[k].abs(), |sum, i| sum + (a[k][i] * v[i]).abs());
        residual[k].abs() <= 8.0 * f64::EPSILON * size
    });
    if met {
        return Ok(());
    }
    let (p, basis) = (momentum(system, t, &q, &v), system.admissible_basis(t, &q));
    let (v, _) = Projection::new(system, t, q, p, basis)
        .solve(&Newton::default(), v)
        .map_err(|source| StepError::Newton { stage: Stage::Projection, source })?;
    state.advance(&[0.0; N], v, None);
    Ok(())
}
