use super::free::recovered;
use super::half_turn::{half_turn, turned};
use super::heading::NO_HEADING;
use super::mean_equations::{Matrix, MeanEquations, MeanPoint};
use super::memory::{Foreseen, Memory};
use super::{ClosedStart, ClosedStep};
use crate::Sleigh;
use lagrangian::{Effect, from_fn, mul_add};

/// A turn in one step (rad) beyond which the general step decides which solution continues the motion.
const NEAR: f64 = 1.0;
/// A part of the velocities by which Newton's correction may change them and leave rounding: what it leaves is the square of that
/// part, by the part of themselves by which the derivatives change along the step.
const SLIGHT: f64 = 1e-8;
/// The first correction must shrink to this part in the second (Newton and Kantorovich).
const CONTRACTION: f64 = 0.25;
/// Rounding of an equation, relative to the sum of its terms.
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// Angles whose square is rounding (rad).
const SMALL: f64 = 1e-8;
/// A part of the velocities by which expected ones may differ from those before.
const FAR: f64 = 0.125;
/// Corrections below this part of the velocities are rounding.
const NOISE: f64 = 1e-11;
/// Maximum number of Newton's corrections, each with two simplified ones after it, before the general step is made.
const MOST: u32 = 4;

/// One step of the midpoint discrete Lagrange-d'Alembert map of a sleigh that is pushed, reduced to two unknowns.
///
/// With the notation of the closed map of the free sleigh, and `f_e`, `f_n`, `tau` the force in the middle of the step, at the mean
/// velocity, along the chord, across it and about the blade, the equations of the step are
///
/// ```text
/// U cos d - a w sin d = u0 + h/(2m) (f_e cos d - f_n sin d),    w (1 + k U) = omega0 + h/(2J) tau    at the beginning,
/// U cos d + a w sin d = u1 - h/(2m) (f_e cos d + f_n sin d),    w (1 - k U) = omega1 - h/(2J) tau    at the end:
/// ```
///
/// These are the equations of the free sleigh with the impulse of half a step at each end. They are solved from velocities extrapolated
/// from earlier steps, from which one of Newton's corrections is mostly enough. Returns `None`, and leaves the step to the general
/// method, if the corrections do not contract or settle, if the blade turns far, or if the step is too long for these equations.
#[inline(always)]
pub(crate) fn step<E: Effect<Sleigh, 3>>(
    sleigh: &Sleigh,
    (t, h): (f64, f64),
    ClosedStart { q, v, xi, memory }: ClosedStart<'_, 3>,
    effects: &E,
) -> Option<ClosedStep<3, 1>> {
    let start = match xi {
        // Not both from there: two numbers that were written one by one are waited for where they are read together.
        Some([u, ..]) => [u, v[2]],
        None => recovered(q[2], v).into(),
    };
    let mut before = remembered(memory, h, q[2], start)?;

    let heading = before.heading.both();
    let equations = MeanEquations::new(sleigh, (t, h), (q, heading), start);
    let (mut matrix, mut at) = equations.linearised(effects, before.expected(), before.half_turn())?;
    let (mut x, mut d) = matrix.corrected(before.expected(), at.missing);
    let mut iterations = 1;
    let slight = |i: usize| d[i].abs() <= SLIGHT * x[i].abs();
    if !(matrix.keeps_sign() & slight(0) & slight(1)) {
        // Built anew, so that what stands above need not be in memory.
        let equations = MeanEquations::new(sleigh, (t, h), (q, heading), start);
        FoundPushed { x, d, at, matrix, iterations } = search(&equations, effects, (x, d, matrix))?;
    }

    // What is left to correct is linear to rounding.
    let ([speed, w], [u0, omega0], half) = (x, start, 0.5 * h);
    let (m, a, e, [sin, cos]) = (sleigh.mass(), sleigh.offset(), half * d[1], at.half_turn);
    let (sin, cos) = (mul_add(e, cos, sin), mul_add(-e, sin, cos));
    let [along, across]: [f64; 2] =
        from_fn(|i| mul_add(matrix.force[i][0], d[0], mul_add(matrix.force[i][1], d[1], at.force[i])));

    // The sum of the equations at the two ends gives the velocities at the second.
    let u1 = mul_add(2.0 * a * w, sin, mul_add(h / m * along, cos, u0));
    let omega1 = mul_add(2.0, w, -omega0);
    before.leave(h, x);
    let half_turn = [sin, cos];
    let ([sin_m, cos_m], way) = (turned(heading, half_turn), h * speed);
    let [sin1, cos1] = before.heading.turn(h * w, sin + sin, [sin_m, cos_m]);
    let equations = MeanEquations::new(sleigh, (t, h), (q, heading), start);
    if equations.overshoots(effects, (x, half_turn), ([u1, omega1], [sin1, cos1])) {
        return None;
    }
    let (turn, spin) = (speed * sin, a * w * cos);
    Some(ClosedStep {
        increment: [way * cos_m, way * sin_m, h * w],
        velocity: [u1 * cos1, u1 * sin1, omega1],
        xi: [u1, omega1, 0.0],
        impulses: [
            [mul_add(m, turn + mul_add(-a, omega0, spin), -half * mul_add(across, cos, along * sin))],
            [mul_add(m, turn + mul_add(a, omega1, -spin), -half * mul_add(across, cos, -along * sin))],
        ],
        iterations,
    })
}

/// What a search has found.
struct FoundPushed {
    x: [f64; 2],
    /// The correction that led there, from a point with these equations and about these derivatives.
    d: [f64; 2],
    at: MeanPoint,
    matrix: Matrix,
    iterations: u32,
}

/// A search that does not end at once. It goes on from a first correction, that led from velocities near those before, or begins at
/// these.
// Out of line, and given and giving numbers alone, so that it is no part of a step that ends at once.
#[cold]
#[inline(never)]
fn search<E: Effect<Sleigh, 3>>(
    equations: &MeanEquations<'_>,
    effects: &E,
    tried: ([f64; 2], [f64; 2], Matrix),
) -> Option<FoundPushed> {
    let &MeanEquations { h, start, .. } = equations;
    let newton = |x: [f64; 2]| {
        let (matrix, at) = equations.linearised(effects, x, half_turn(0.5 * h * x[1]).ok()?.into())?;
        let (x, d) = matrix.corrected(x, at.missing);
        Some((x, d, matrix))
    };
    let near = |x: &[f64; 2], d: &[f64; 2]| size(from_fn(|i| x[i] - d[i] - start[i])) <= FAR * size(start);
    let (mut x, mut d, mut matrix) = match tried {
        (x, d, matrix) if near(&x, &d) => (x, d, matrix),
        _ => newton(start)?,
    };
    let (first, mut iterations) = (size(d), 1);
    for _ in 0..MOST {
        if !matrix.keeps_sign() {
            return None;
        }
        for _ in 0..2 {
            let (before, at) = (d, equations.at(effects, x)?);
            (x, d) = matrix.corrected(x, at.missing);
            iterations += 1;
            if iterations == 2 && size(d) > CONTRACTION * first && size(d) > NOISE * size(x) {
                return None;
            }
            let rounding = |i: usize| ROUNDING * at.terms[i];
            let settled =
                (0..2).all(|i| d[i].abs() <= rounding(i) || 2.0 * d[i] * d[i] <= rounding(i) * before[i].abs());
            if settled && (h * d[1]).abs() <= SMALL {
                return ((h * x[1]).abs() <= NEAR).then_some(FoundPushed { x, d, at, matrix, iterations });
            }
        }
        (x, d, matrix) = newton(x)?;
        iterations += 1;
    }
    None
}

/// The larger size of two corrections.
#[inline(always)]
fn size([a, b]: [f64; 2]) -> f64 {
    a.abs().max(b.abs())
}

/// Number of backward differences of the mean velocities that are kept; the first are the last mean velocities themselves.
const KEPT: usize = 8;
const SIZE: usize = 6 + 2 * KEPT;
/// Identifies these numbers and their order. A checkpoint may come from an older version or another map.
const KIND: f64 = 6.0;

/// The numbers that a step of the pushed map leaves to the next.
type MeanMemory<'a> = Foreseen<'a, 2, KEPT, SIZE>;

/// The numbers left by steps of length `h`, for a step that begins at this heading with the velocities `x`. If there are none, they are
/// as after many steps with the velocities `x`; `None` if the blade would then turn by a right angle in half the step.
#[inline(always)]
fn remembered(memory: &mut Memory, h: f64, heading: f64, x: [f64; 2]) -> Option<MeanMemory<'_>> {
    if !memory.is_of(h, KIND) {
        begin(memory, h, x)?;
    }
    Some(Foreseen::of(memory, heading))
}

// A call, since few steps come here, into memory, where what was remembered is read from.
#[cold]
#[inline(never)]
fn begin(memory: &mut Memory, h: f64, x: [f64; 2]) -> Option<()> {
    let (sin, cos) = half_turn(0.5 * h * x[1]).ok()?;
    memory.begin(h, KIND);
    let (heading, numbers) = memory.parts::<_, SIZE>();
    (*numbers, *heading) = ([0.0; SIZE], NO_HEADING);
    numbers[..8].copy_from_slice(&[sin, cos, x[0], x[1], x[0], x[1], x[0], x[1]]);
    Some(())
}
