use crate::Sleigh;
use lagrangian::{ClosedStep, ClosedStepError};
use std::f64::consts::FRAC_PI_2;

/// An error in `r` of this size is rounding.
pub(crate) const ROUNDING: f64 = 1e-17;
/// The cube of an angle this small is rounding.
const SMALL: f64 = 1e-6;
/// A part of the spin by which an expected one may differ from that before.
const FAR: f64 = 0.125;
const MAX_ITERATIONS: u32 = 30;
pub(crate) const SMALL: f64 = 1e-6;
pub(crate) const MAX_ITERATIONS: u32 = 30;
/// The series of `sin d = d + d^3 (s_0 + s_1 d^2 + ..)` and `cos d = 1 - d^2/2 + d^4 (c_0 + c_1 d^2 + ..)`.
pub(crate) const SINE: [f64; 5] = [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0];
pub(crate) const COSINE: [f64; 5] = [1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0, 1.0 / 479_001_600.0];

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
/// that is `F_h(U, w) = (u0, J omega0)`, `F_-h(U, w) = (u1, J omega1)`: the map is its own adjoint (the book, (3.6) and
/// (3.7)). The first equation gives `U cos d`, the second is solved for `w` by Newton's method, in which `omega0` is but a
/// factor, so that the spin keeps its sign and all its digits however small it is. Among the solutions the one that continues the motion has `|d| < pi/2` and
/// `1 + k U > 0`; the map ends where these do.
#[inline(always)]
pub(crate) fn step(
    sleigh: &Sleigh,
    h: f64,
    q: &[f64; 3],
    v: &[f64; 3],
    xi: Option<[f64; 3]>,
    expected: Option<f64>,
) -> Result<ClosedStep<3, 1>, ClosedStepError> {
    let (m, a) = (sleigh.mass(), sleigh.offset());
    let k = 0.5 * h * sleigh.spin_gain();
    let (sin0, cos0) = q[2].sin_cos();
    let (u0, omega0) = match xi {
        Some([u, omega, _]) => (u, omega),
        None => recovered(sin0, cos0, v),
    };
    let (reach, d) = (a * omega0, 0.5 * h * omega0);

    // What is expected does not wait for the end of the step before, nor its sine for a division.
    let half = 0.5 * h;
    let near = expected.map(|turn| (turn, turn / h)).filter(|(_, w)| (w - omega0).abs() <= FAR * omega0.abs());
    let (mut w, (mut sin, mut cos)) = match near {
        Some((turn, w)) => (w, half_turn(0.5 * turn)?),
        None => {
            let w = omega0 * prediction(k, u0, reach, d);
            (w, half_turn(half * w)?)
        }
    };
    // How far f is from a straight line, which bounds the error that a correction leaves.
    let bend = (k * reach * d).abs() + d * d;
    let mut iterations = 0;
    let across = loop {
        // f(w) = w (1 + k U) cos d - omega0 cos d, with U cos d = u0 + a w sin d; and a w sin d with its slope.
        let (part, part_of_w) = (a * w * sin, a * (sin + half * w * cos));
        let growth = cos + k * (u0 + part);
        let slope = growth + k * w * part_of_w + (omega0 - w) * half * sin;
        let correction = (omega0 * cos - w * growth) / slope;
        w += correction;
        iterations += 1;
        let e = half * correction;
        if bend * correction * correction <= ROUNDING * (w * w) && e.abs() <= SMALL {
            // What is still to be done is linear, to rounding, and need not wait for new sines.
            (sin, cos) = (sin + e * (cos - 0.5 * e * sin), cos - e * (sin + 0.5 * e * cos));
            break part + correction * part_of_w;
        }
        (sin, cos) = half_turn(half * w)?;
        if iterations == MAX_ITERATIONS || correction.is_nan() {
            return Err(failure(k * u0, iterations, correction / w));
        }
    };
    // (1 + k U) cos d, the sign of w / omega0.
    let growth = cos + k * (u0 + across);
    if growth <= 0.0 {
        return Err(out_of_branch(growth / cos - 1.0));
    }

    // With w (1 + k U) = omega0: omega1 = w (1 - k U) = 2 w - omega0.
    let (u1, omega1) = (u0 + 2.0 * across, 2.0 * w - omega0);
    if !(u1 + omega1).is_finite() {
        return Err(ClosedStepError::NotFinite { quantity: "the new velocity" });
    }

    // The directions of the blade half a step and a step later.
    let (cos_m, sin_m) = (cos0 * cos - sin0 * sin, sin0 * cos + cos0 * sin);
    let (cos1, sin1) = (cos_m * cos - sin_m * sin, sin_m * cos + cos_m * sin);
    let mean_speed = (u0 + across) / cos;
    let (turn, spin) = (mean_speed * sin, a * w * cos);
    Ok(ClosedStep {
        increment: [h * mean_speed * cos_m, h * mean_speed * sin_m, h * w],
        velocity: [u1 * cos1, u1 * sin1, omega1],
        xi: [u1, omega1, 0.0],
        impulses: [[m * (turn + (spin - reach))], [m * (turn + (a * omega1 - spin))]],
        iterations,
    })
}

/// Quasi-velocities of a velocity. Out of line, so that where they are known the search for `r` is a branch that does not
/// wait for the trigonometry of the heading, and not a selection that does.
#[cold]
#[inline(never)]
pub(crate) fn recovered(sin0: f64, cos0: f64, v: &[f64; 3]) -> (f64, f64) {
    (v[0] * cos0 + v[1] * sin0, v[2])
}

/// A first guess of `r = 1 / (1 + k U)`, with `U = u0 + r^2 (a omega0 d + u0 d^2 / 2) + O(d^4)`.
#[inline(always)]
fn prediction(k: f64, u0: f64, reach: f64, d: f64) -> f64 {
    let growth = 1.0 + k * u0;
    if growth <= 0.0 {
        return 1.0;
    }
    let r = growth.recip();
    let rr = r * r;
    r - k * (reach * d + 0.5 * u0 * d * d) * (rr * rr)
}

/// Sine and cosine of half the turn of a step, which must stay below a right angle.
#[inline(always)]
pub(crate) fn half_turn(d: f64) -> Result<(f64, f64), ClosedStepError> {
    if d.abs() <= 0.25 {
        // Their series, to the first term below rounding, summed in pairs: no range to reduce, little to wait for.
        let z = d * d;
        let zz = z * z;
        let sum = |c: &[f64; 5]| (c[0] + z * c[1]) + zz * ((c[2] + z * c[3]) + zz * c[4]);
        let (s, c) = (sum(&SINE), sum(&COSINE));
        Ok((d + d * z * s, 1.0 - (0.5 * z - zz * c)))
    } else if d.abs() < FRAC_PI_2 {
        Ok(d.sin_cos())
    } else {
        Err(too_far(d))
    }
}

#[cold]
fn too_far(d: f64) -> ClosedStepError {
    if d.is_nan() {
        ClosedStepError::NotFinite { quantity: "the turn of a step" }
    } else {
        ClosedStepError::NoSolution {
            quantity: "the turn of half a step, h omega/2,",
            value: d.abs(),
            bound: FRAC_PI_2,
        }
    }
}

#[cold]
fn failure(gain: f64, iterations: u32, correction: f64) -> ClosedStepError {
    if !gain.is_finite() {
        ClosedStepError::NotFinite { quantity: "h m a u / (2 J)" }
    } else if gain <= -1.0 {
        out_of_branch(gain)
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
