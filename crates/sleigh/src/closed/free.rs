use super::spin_equation::{FoundTurn, SpinEquation, out_of_branch, settled};
use super::spin_memory::{SpinNumbers, is_least, remembered, search_least};
use super::{ClosedStart, ClosedStep};
use crate::Sleigh;
use dla::ClosedStepError;
use lagrangian::{mul_add, sin_cos_wrapped};

/// A part of the spin by which an expected one may differ from that before.
const FAR: f64 = 0.125;

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
///
/// The search begins at a spin that those before the last one lead to, so that only two sums, a division and a sum wait for the
/// step before.
#[inline(always)]
pub(crate) fn step(
    sleigh: &Sleigh,
    h: f64,
    ClosedStart { q, v, xi, memory }: ClosedStart<'_, 3>,
) -> Result<ClosedStep<3, 1>, ClosedStepError> {
    let equation = SpinEquation::new(sleigh, h);
    let a = equation.a;
    let (u0, mut omega0) = match xi {
        // Not both from there: two numbers that were written one by one are waited for where they are read together.
        Some([u, ..]) => (u, v[2]),
        None => recovered(q[2], v),
    };

    let mut before = remembered(memory, h, (q[2], omega0));
    let [expected] = before.expected();
    let mut point = equation.point(expected, before.half_turn().into());
    let mut correction = equation.correction(&point, u0, omega0);
    let mut iterations = 1;
    if !equation.settles(correction) {
        let found = search(sleigh, h, (u0, omega0), before.numbers)?;
        point = equation.point(found.w, found.half_turn);
        (correction, omega0, iterations) = (found.correction, found.omega0, found.iterations);
    }

    // What is still to be done is linear to rounding, but for a w sin d, and need not wait for new sines. Nor for a quotient: U is
    // (U cos d) / cos d, and with the tangent there is none but that by the cosine that was expected.
    let (w, e) = (point.w + correction, equation.half * correction);
    let (sin, cos) = (mul_add(e, point.cos, point.sin), mul_add(-e, point.sin, point.cos));
    let secant = point.cos.recip();
    let tan = mul_add(e, secant * secant, point.sin * secant);
    let slope = mul_add(a * equation.half, correction, point.across_of_w);
    let across = mul_add(correction, slope, point.across);
    // U cos d, and (1 + k U) cos d, the sign of w / omega0.
    let along = u0 + across;
    let growth = mul_add(equation.k, along, cos);

    // With w (1 + k U) = omega0: omega1 = w (1 - k U) = 2 w - omega0. Little of both waits for the correction.
    let u1 = mul_add(correction, 2.0 * slope, mul_add(2.0, point.across, u0));
    let omega1 = 2.0 * w - omega0;

    // The direction of the blade in the middle, over cos d; that at the end is that at the beginning with sin 2 d of it.
    let [sin0, cos0] = before.heading.both();
    let (sin_m, cos_m) = (mul_add(tan, cos0, sin0), mul_add(-tan, sin0, cos0));
    let (turn, spin, way) = (along * tan, a * (w * cos), h * along);
    if growth <= 0.0 {
        return Err(out_of_branch(growth / cos - 1.0));
    }
    before.leave(h, [w]);
    let [sin1, cos1] = before.heading.turn(h * w, (sin + sin) * cos, [sin_m, cos_m]);
    Ok(ClosedStep {
        increment: [way * cos_m, way * sin_m, h * w],
        velocity: [u1 * cos1, u1 * sin1, omega1],
        xi: [u1, omega1, 0.0],
        impulses: [[sleigh.mass() * (turn + (spin - a * omega0))], [sleigh.mass() * (turn + (a * omega1 - spin))]],
        iterations,
    })
}

/// A search that does not settle at once, from the expected spin where that is near, or one guessed from the velocities.
// Out of line, and given and giving numbers alone, so that it is no part of a step that settles at once.
#[cold]
#[inline(never)]
fn search(
    sleigh: &Sleigh,
    h: f64,
    (u0, omega0): (f64, f64),
    numbers: &mut SpinNumbers,
) -> Result<FoundTurn, ClosedStepError> {
    let equation = SpinEquation::new(sleigh, h);
    if is_least(u0, omega0) {
        return search_least(equation, (u0, omega0), numbers);
    }
    let expected = numbers[2];
    let near = (expected - omega0).abs() <= FAR * omega0.abs();
    settled(&equation, if near { expected } else { equation.guess(u0, omega0) }, (u0, omega0))
}

/// Quasi-velocities of a velocity. Out of line, so that where they are known the search for `w` is a branch that does not
/// wait for the trigonometry of the heading, and not a selection that does.
#[cold]
#[inline(never)]
pub(crate) fn recovered(heading: f64, v: &[f64; 3]) -> (f64, f64) {
    let (sin0, cos0) = sin_cos_wrapped(heading);
    (v[0] * cos0 + v[1] * sin0, v[2])
}
