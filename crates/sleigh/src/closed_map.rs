use crate::Sleigh;
use lagrangian::{ClosedStep, ClosedStepError, Scalar};
use std::f64::consts::FRAC_PI_2;

/// A correction this small, relative, leaves an error below rounding: the iteration converges quadratically.
const SETTLED: f64 = 1e-9;
const MAX_ITERATIONS: u32 = 30;

/// One step of the midpoint discrete Lagrange-d'Alembert map of the free sleigh, reduced to one unknown.
///
/// With the mean velocities `U` along the chord and `w` about the blade, `d = h w/2` and `k = h m a / (2 J)`, the
/// equations of the step are
///
/// ```text
/// U cos d - a w sin d = u0,        w (1 + k U) = omega0        at the beginning,
/// U cos d + a w sin d = u1,        w (1 - k U) = omega1        at the end,
/// ```
///
/// that is `F_h(U, w) = (u0, J omega0)`, `F_-h(U, w) = (u1, J omega1)`: the map is its own adjoint. The first equation
/// gives `U`, the second is solved for the ratio `r = w/omega0` by Newton's method, so that the spin keeps its sign and
/// all its digits however small it is. Among the solutions the one that continues the motion has `|d| < pi/2` and
/// `1 + k U > 0`; the map ends where these do.
pub(crate) fn step(
    sleigh: &Sleigh,
    h: f64,
    q: &[f64; 3],
    v: &[f64; 3],
) -> Result<ClosedStep<3, 1>, ClosedStepError> {
    let (m, a) = (sleigh.mass(), sleigh.offset());
    let k = 0.5 * h * (m * a / sleigh.pivot_inertia());
    let (sin0, cos0) = Scalar::sin_cos(q[2]);
    let u0 = v[0] * cos0 + v[1] * sin0;
    let omega0 = v[2];

    let start = 1.0 + k * (u0 + 0.5 * h * a * omega0 * omega0);
    let mut r = if start > 0.0 { start.recip() } else { 1.0 };
    let d_of_r = 0.5 * h * omega0;
    let mut iterations = 0;
    let mut correction;
    let (mut sin, mut cos) = half_turn(d_of_r * r)?;
    loop {
        let (d, w) = (d_of_r * r, omega0 * r);
        let per_cos = cos.recip();
        let mean_speed = (u0 + a * w * sin) * per_cos;
        let speed_of_r = (a * omega0 * (sin + d * cos) + mean_speed * sin * d_of_r) * per_cos;
        let growth = 1.0 + k * mean_speed;
        correction = (1.0 - r * growth) / (growth + k * r * speed_of_r);
        r += correction;
        iterations += 1;
        (sin, cos) = turned(sin, cos, d_of_r * correction, d_of_r * r)?;
        if correction.abs() <= SETTLED * r.abs() {
            break;
        }
        if iterations == MAX_ITERATIONS || correction.is_nan() {
            return Err(failure(k, u0, iterations, correction / r));
        }
    }

    let w = omega0 * r;
    let mean_speed = (u0 + a * w * sin) / cos;
    let gain = k * mean_speed;
    if gain <= -1.0 {
        return Err(out_of_branch(gain));
    }
    let (along, across) = (mean_speed * cos, a * w * sin);
    let (u1, omega1) = (along + across, w * (1.0 - gain));

    // The directions of the blade half a step and a step later.
    let (cos_m, sin_m) = (cos0 * cos - sin0 * sin, sin0 * cos + cos0 * sin);
    let (cos1, sin1) = (cos_m * cos - sin_m * sin, sin_m * cos + cos_m * sin);
    let (turn, spin) = (mean_speed * sin, a * w * cos);
    let result = ClosedStep {
        increment: [h * mean_speed * cos_m, h * mean_speed * sin_m, h * w],
        velocity: [u1 * cos1, u1 * sin1, omega1],
        impulses: [[m * (turn + (spin - a * omega0))], [m * (turn + (a * omega1 - spin))]],
        iterations,
    };
    if (u1 + omega1).is_finite() { Ok(result) } else { Err(ClosedStepError::NotFinite { quantity: "the new velocity" }) }
}

/// Sine and cosine of the half turn `d = h w/2`, which must stay below a right angle.
#[inline(always)]
fn half_turn(d: f64) -> Result<(f64, f64), ClosedStepError> {
    if d.abs() < FRAC_PI_2 {
        Ok(Scalar::sin_cos(d))
    } else if d.is_nan() {
        Err(ClosedStepError::NotFinite { quantity: "the turn of a step" })
    } else {
        Err(ClosedStepError::NoSolution { quantity: "the turn of half a step, h omega/2,", value: d, bound: FRAC_PI_2 })
    }
}

/// Sine and cosine after `d` has changed by `change` to `d`: by their series where three terms are exact to rounding.
#[inline(always)]
fn turned(sin: f64, cos: f64, change: f64, d: f64) -> Result<(f64, f64), ClosedStepError> {
    if change.abs() < 3e-6 {
        let bend = 0.5 * change * change;
        Ok((sin + (change * cos - bend * sin), cos - (change * sin + bend * cos)))
    } else {
        half_turn(d)
    }
}

#[cold]
fn failure(k: f64, u0: f64, iterations: u32, correction: f64) -> ClosedStepError {
    if !(k * u0).is_finite() {
        ClosedStepError::NotFinite { quantity: "h m a u / (2 J)" }
    } else if k * u0 <= -1.0 {
        out_of_branch(k * u0)
    } else {
        ClosedStepError::IterationLimit { iterations, correction }
    }
}

#[cold]
fn out_of_branch(gain: f64) -> ClosedStepError {
    ClosedStepError::NoSolution {
        quantity: "the growth of the spin in half a step, -h m a u / (2 J),",
        value: -gain,
        bound: 1.0,
    }
}
