use crate::dependent::named_rows;
use crate::{Hint, Mechanics, NewtonError, NotANumber, State, StepError, SystemFunction};
use lagrangian::linear::Singular;
use lagrangian::{MotionError, ReducedError, from_fn};

impl StepError {
    /// Whether the step may have failed because something is not a number, or not finite.
    pub(crate) fn has_lost_numbers(&self) -> bool {
        let lost = |source: &Singular| !source.pivot.is_finite();
        match self {
            Self::Newton { source, .. } => match source {
                NewtonError::Singular { source, .. } => lost(source),
                NewtonError::Diverged { correction, .. } | NewtonError::IterationLimit { correction, .. } => {
                    !correction.is_finite()
                }
                NewtonError::NotFinite { .. } => true,
            },
            Self::Motion(MotionError { source, .. })
            | Self::Reduced(ReducedError::Motion(MotionError { source, .. })) => lost(source),
            Self::Energy { defect, .. } => !defect.is_finite(),
            // An adaptive method takes shorter and shorter steps if a function is NaN.
            Self::NotFinite | Self::Tolerance { .. } => true,
            _ => false,
        }
    }
}

/// The error of equations at a place. It names the function that is not finite there, if that is the cause.
#[cold]
#[inline(never)]
pub(crate) fn suspect_at<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    error: StepError,
) -> StepError {
    if !error.has_lost_numbers() {
        return error;
    }
    let found = |found| told(system, (t, q, v), NotANumber { at_node: false, ..found });
    system.not_a_number(t, q, v).map_or(error, found)
}

/// The error of a function that is not finite. A basis that is derived by elimination does not exist if rows depend on one another: then
/// the rows are named.
#[cold]
fn told<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t, q, v): (f64, &[f64; N], &[f64; N]),
    found: NotANumber,
) -> StepError {
    let error = StepError::NotANumber(found);
    match found.function {
        SystemFunction::Basis { .. } => named_rows(system, t, q, v, error),
        _ => error,
    }
}

/// The error of a step from `state`. It names the function that is not finite at the beginning, in the middle or at the end of the step,
/// with the velocity at the beginning or with `v`, if that is the cause.
#[cold]
#[inline(never)]
pub(crate) fn suspect_along<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    state: &State<N>,
    v: &[f64; N],
    error: StepError,
) -> StepError {
    if let (Some(Hint::ShorterStep { .. }), Some(coordinate)) =
        (error.hint(), jumps_at_rest(system, t0, state.q(), state.v()))
    {
        return StepError::JumpsAtRest { coordinate };
    }
    if !error.has_lost_numbers() {
        return error;
    }
    if let Some(found) = system.not_a_number(t0, state.q(), state.v()) {
        return told(system, (t0, state.q(), state.v()), found);
    }
    let mut error = error;
    for v in [state.v(), v] {
        for part in [0.0, 0.5, 1.0] {
            let q = state.ahead(&from_fn(|i| part * h * v[i]));
            error = suspect_at(system, t0 + part * h, &q, v, error);
        }
    }
    error
}

/// So near to rest smooth forces are the same from both sides, but for this part of their size at the velocity.
const NEAR: f64 = 1e-12;

/// Fails if a force that jumps at rest holds the system there: it drives a velocity along `v` back to zero, and one against `v` too. An
/// explicit step would go to and fro, and creep.
#[cold]
#[inline(never)]
pub(crate) fn not_held_at_rest<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<(), StepError> {
    let Some(coordinate) = jumps_at_rest(system, t, q, v) else { return Ok(()) };
    let pushed = |part: f64| {
        let motion = system.motion(t, q, &v.map(|v| part * v)).ok();
        motion.is_some_and(|motion| part * v[coordinate] * motion.acceleration[coordinate] < 0.0)
    };
    if pushed(NEAR) && pushed(-NEAR) { Err(StepError::JumpsAtRest { coordinate }) } else { Ok(()) }
}

/// The coordinate whose force at rest differs from one side to the other: Coulomb's friction, written with `sign`.
fn jumps_at_rest<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Option<usize> {
    let force = |part: f64| system.force(t, q, &v.map(|v| part * v));
    let (before, after, there) = (force(NEAR)?, force(-NEAR)?, force(1.0)?);
    (0..N).find(|&i| (before[i] - after[i]).abs() > 0.1 * there[i].abs().max(before[i].abs()))
}
