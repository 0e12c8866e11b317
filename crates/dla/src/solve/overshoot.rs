use crate::{Mechanics, StepError};
use lagrangian::from_fn;

/// Checks that the step is short enough for its damping: friction may brake a velocity in a step, and must not reverse it.
///
/// A rule for the mean velocity `v` leads from `v0` past it to `v1`. With `w = v1 - v`, a damping that changes the force by
/// `-C w` makes of it, for the part of the velocity that it acts on,
///
/// ```text
/// (M + h C/2) v = M v0,      M v1 = (M - h C/2) v,
/// ```
///
/// so that beyond `h C/2 = M` the velocity changes its sign in every step though no force drives it there. The two sides are
/// compared along `w`, in the middle of the step. A force that does not depend on the velocity never overshoots.
///
/// # Errors
/// [`StepError::Overshoot`] with the part of the step at which they are equal.
#[inline(always)]
pub(crate) fn brakes_only<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    q0: &[f64; N],
    (v, v1): (&[f64; N], &[f64; N]),
) -> Result<(), StepError> {
    let (t, q) = (t0 + 0.5 * h, from_fn(|i| q0[i] + 0.5 * h * v[i]));
    let forces = system.force(t, &q, v).zip(system.force(t, &q, v1));
    let damping = forces.map_or(0.0, |(mean, end)| damping(h, [v, v1], [&mean, &end]));
    if damping <= 0.0 || damping.is_nan() {
        return Ok(());
    }
    overshoot(damping, inertia([v, v1], [&system.momentum(t, &q, v), &system.momentum(t, &q, v1)]))
}

/// The damping of the change of velocity from `v`, in the middle of a step of length `h` (s), to `v1` at its end (J). `forces` has the forces at
/// the two velocities, in the middle of the step.
#[inline(always)]
#[must_use]
pub fn damping(h: f64, [v, v1]: [&[f64]; 2], [mean, end]: [&[f64]; 2]) -> f64 {
    v.iter().zip(v1).zip(mean.iter().zip(end)).map(|((v, v1), (mean, end))| 0.5 * h * (v1 - v) * (mean - end)).sum()
}

/// The inertia of that change, and `|v . p|` (J); `mean` and `end` are the momenta of the two velocities.
#[must_use]
pub fn inertia([v, v1]: [&[f64]; 2], [mean, end]: [&[f64]; 2]) -> [f64; 2] {
    let change = v.iter().zip(v1).zip(mean.iter().zip(end)).map(|((v, v1), (mean, end))| (v1 - v) * (end - mean));
    [change.sum(), v.iter().zip(mean).map(|(v, p)| (v * p).abs()).sum()]
}

/// Compares the damping of a step with its inertia.
///
/// # Errors
/// [`StepError::Overshoot`] if the damping is larger.
pub fn overshoot(damping: f64, [inertia, all]: [f64; 2]) -> Result<(), StepError> {
    /// If the change of the velocity is a smaller fraction of the velocity (squared), it is round-off.
    const ROUNDING: f64 = 1e-16;
    if damping > inertia && inertia > ROUNDING * all {
        return Err(StepError::Overshoot { part: inertia / damping });
    }
    Ok(())
}
