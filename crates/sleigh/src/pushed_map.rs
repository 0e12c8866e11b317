use crate::Sleigh;
use crate::closed_map::recovered;
use crate::half_turn::half_turn;
use lagrangian::{ClosedStep, Dual, KnownAngle, Push, Start, sin_cos_wrapped};
use std::array::from_fn;

/// A turn in one step (rad) beyond which the general step looks for what continues the motion.
const NEAR: f64 = 1.0;
/// The first correction must shrink to this part in the second (Newton and Kantorovich).
const CONTRACTION: f64 = 0.25;
/// Rounding of an equation, relative to the sum of its terms.
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// The cube of an angle this small is rounding.
const SMALL: f64 = 1e-6;
/// A part of the velocities by which expected ones may differ from those before.
const FAR: f64 = 0.125;
/// Corrections below this part of the velocities are rounding.
const NOISE: f64 = 1e-11;
/// As many of Newton's corrections, each with two simplified ones after it, before the general step is made.
const MOST: u32 = 4;

/// One step of the midpoint discrete Lagrange-d'Alembert map of a sleigh in a potential, reduced to two unknowns.
///
/// With the notation of the closed map of the free sleigh, and `f_e`, `f_n`, `tau` the force of the potential in the middle of
/// the step, along the chord, across it and about the blade, the equations of the step are
///
/// ```text
/// U cos d - a w sin d = u0 + h/(2m) (f_e cos d - f_n sin d),    w (1 + k U) = omega0 + h/(2J) tau    at the beginning,
/// U cos d + a w sin d = u1 - h/(2m) (f_e cos d + f_n sin d),    w (1 - k U) = omega1 - h/(2J) tau    at the end:
/// ```
///
/// those of the free sleigh, with the impulse of half a step at each end. Each of Newton's corrections is followed by simplified ones.
/// None where they do not contract or settle, where the blade turns far, or where the equations are no longer those of a short
/// step: the general step then decides.
#[inline]
pub(crate) fn step<P: Push<3>>(
    sleigh: &Sleigh,
    (t, h): (f64, f64),
    begin: &Start<'_, 3>,
    push: &P,
) -> Option<ClosedStep<3, 1>> {
    let (sin0, cos0) = sin_cos_wrapped(begin.q[2]);
    let start = match begin.xi {
        Some([u, omega, _]) => (u, omega),
        None => recovered((sin0, cos0), begin.v),
    };
    let half = 0.5 * h;
    let equations = Equations {
        sleigh,
        t,
        h,
        q: begin.q,
        start: [start.0, start.1],
        heading: [sin0, cos0],
        gains: [half / sleigh.mass(), half / sleigh.pivot_inertia(), half * sleigh.spin_gain()],
    };

    let (mut x, mut turn) = equations.guess(begin.expected)?;
    let (mut first, mut iterations) = (f64::INFINITY, 0);
    for _ in 0..MOST {
        let (matrix, at) = equations.linearised(push, x, turn)?;
        let guessed = x;
        let mut before = matrix.correction(at.missing);
        x = from_fn(|i| x[i] + before[i]);
        iterations += 1;
        if iterations == 1 {
            first = size(before);
        }
        for simplified in 0..2 {
            let found = equations.at(push, x)?;
            let d = matrix.correction(found.missing);
            let small = |i: usize| d[i].abs() <= ROUNDING * found.terms[i];
            if simplified == 0 && small(0) && small(1) && (h * before[1]).abs() <= SMALL {
                // Newton's correction leaves rounding alone. Nothing but this answer waits for the second point.
                let from = from_fn(|i| x[i] - guessed[i]);
                return equations.end(x, from, &at, &matrix).map(|step| ClosedStep { iterations, ..step });
            }
            x = from_fn(|i| x[i] + d[i]);
            iterations += 1;
            if iterations == 2 && size(d) > CONTRACTION * first && size(d) > NOISE * size(x) {
                return None;
            }
            let settled = (0..2).all(|i| small(i) || 2.0 * d[i] * d[i] <= ROUNDING * found.terms[i] * before[i].abs());
            if settled && (h * d[1]).abs() <= SMALL {
                return equations.end(x, d, &found, &matrix).map(|step| ClosedStep { iterations, ..step });
            }
            before = d;
        }
        let (sin, cos) = half_turn(half * x[1]).ok()?;
        turn = [sin, cos];
    }
    None
}

/// The larger size of two corrections.
#[inline(always)]
fn size([a, b]: [f64; 2]) -> f64 {
    a.abs().max(b.abs())
}

/// The equations for `U` and `w`.
struct Equations<'a> {
    sleigh: &'a Sleigh,
    t: f64,
    h: f64,
    q: &'a [f64; 3],
    /// `u0`, `omega0`.
    start: [f64; 2],
    /// Sine and cosine of the heading at the beginning.
    heading: [f64; 2],
    /// `h/(2m)`, `h/(2J)`, `k`.
    gains: [f64; 3],
}

/// What the equations are at one point.
struct Point {
    /// By how much they are missed.
    missing: [f64; 2],
    /// The sums of the sizes of their terms.
    terms: [f64; 2],
    /// Sine and cosine of `d`.
    half_turn: [f64; 2],
    /// `f_e`, `f_n`.
    force: [f64; 2],
}

/// The derivatives of the equations in `U` and `w`, inverted.
struct Matrix {
    inverse: [[f64; 2]; 2],
    /// Those of `f_e`, `f_n`.
    force: [[f64; 2]; 2],
}

impl Matrix {
    #[inline(always)]
    fn correction(&self, missing: [f64; 2]) -> [f64; 2] {
        from_fn(|i| -(self.inverse[i][0] * missing[0] + self.inverse[i][1] * missing[1]))
    }
}

impl Equations<'_> {
    /// The expected velocities where they are near those before, or else these; with the sine and cosine of the half turn.
    #[inline(always)]
    fn guess(&self, expected: Option<[f64; 3]>) -> Option<([f64; 2], [f64; 2])> {
        let [sin0, cos0] = self.heading;
        if let Some([dx, dy, turn]) = expected
            && let Ok((sin, cos)) = half_turn(0.5 * turn)
        {
            // The chord is along the mean heading.
            let chord = dx * (cos0 * cos - sin0 * sin) + dy * (sin0 * cos + cos0 * sin);
            let x = [chord / self.h, turn / self.h];
            if size(from_fn(|i| x[i] - self.start[i])) <= FAR * size(self.start) {
                return Some((x, [sin, cos]));
            }
        }
        let (sin, cos) = half_turn(0.5 * self.h * self.start[1]).ok()?;
        Some((self.start, [sin, cos]))
    }

    /// The middle of the step: the chord, and the configuration.
    #[inline(always)]
    fn middle(&self, [speed, w]: [f64; 2], [sin, cos]: [f64; 2]) -> ([f64; 2], [f64; 3]) {
        let ([sin0, cos0], half) = (self.heading, 0.5 * self.h);
        let chord = [sin0 * cos + cos0 * sin, cos0 * cos - sin0 * sin];
        let way = half * speed;
        (chord, [self.q[0] + way * chord[1], self.q[1] + way * chord[0], self.q[2] + half * w])
    }

    #[inline(always)]
    fn point(&self, [speed, w]: [f64; 2], half_turn: [f64; 2], chord: [f64; 2], [fx, fy, tau]: [f64; 3]) -> Point {
        let ([u0, omega0], [sin, cos], a) = (self.start, half_turn, self.sleigh.offset());
        let [of_mass, of_inertia, k] = self.gains;
        let force @ [along, across] = [chord[1] * fx + chord[0] * fy, chord[1] * fy - chord[0] * fx];
        let [carried, turned, pushed] = [speed * cos, a * w * sin, of_mass * (along * cos - across * sin)];
        let [grown, torque] = [w * (1.0 + k * speed), of_inertia * tau];
        Point {
            missing: [(carried - turned) - (u0 + pushed), grown - (omega0 + torque)],
            terms: [carried.abs() + turned.abs() + u0.abs() + pushed.abs(), grown.abs() + omega0.abs() + torque.abs()],
            half_turn,
            force,
        }
    }

    #[inline(always)]
    fn at<P: Push<3>>(&self, push: &P, x: [f64; 2]) -> Option<Point> {
        let (sin, cos) = half_turn(0.5 * self.h * x[1]).ok()?;
        let (chord, [qx, qy, heading]) = self.middle(x, [sin, cos]);
        let heading = KnownAngle::new(heading, chord[0], chord[1]);
        let t = KnownAngle::from(self.t + 0.5 * self.h);
        let force = push.push(t, &[KnownAngle::from(qx), KnownAngle::from(qy), heading])?;
        Some(self.point(x, [sin, cos], chord, force.map(|f| f.re)))
    }

    /// The same with the derivatives; none where their determinant, one for a step of length zero, has changed its sign.
    #[inline(always)]
    fn linearised<P: Push<3>>(&self, push: &P, x: [f64; 2], half_turn: [f64; 2]) -> Option<(Matrix, Point)> {
        let (chord, [qx, qy, heading]) = self.middle(x, half_turn);
        let ([speed, w], half) = (x, 0.5 * self.h);
        let way = half * speed;
        let seeded = |re: KnownAngle, eps: [f64; 2]| Dual { re, eps: eps.map(KnownAngle::from) };
        let q = [
            seeded(KnownAngle::from(qx), [half * chord[1], -half * way * chord[0]]),
            seeded(KnownAngle::from(qy), [half * chord[0], half * way * chord[1]]),
            seeded(KnownAngle::new(heading, chord[0], chord[1]), [0.0, half]),
        ];
        let force = push.push(Dual::fixed(KnownAngle::from(self.t + half)), &q)?;
        let at = self.point(x, half_turn, chord, force.map(|f| f.re.re));

        let ([sin, cos], [along, across]) = (half_turn, at.force);
        let (a, [of_mass, of_inertia, k]) = (self.sleigh.offset(), self.gains);
        let [fx, fy, tau] = force.map(|f| f.eps.map(|x| x.re));
        // The chord turns by half a step's turn.
        let turning = [0.0, half];
        let along_of: [f64; 2] = from_fn(|i| chord[1] * fx[i] + chord[0] * fy[i] + turning[i] * across);
        let across_of: [f64; 2] = from_fn(|i| chord[1] * fy[i] - chord[0] * fx[i] - turning[i] * along);
        let pushed: [f64; 2] =
            from_fn(|i| of_mass * (along_of[i] * cos - across_of[i] * sin - turning[i] * (along * sin + across * cos)));
        let first = [cos - pushed[0], -(half * speed * sin + a * (sin + half * w * cos)) - pushed[1]];
        let second = [k * w - of_inertia * tau[0], 1.0 + k * speed - of_inertia * tau[1]];
        let determinant = first[0] * second[1] - first[1] * second[0];
        let scale = determinant.recip();
        let inverse = [[second[1] * scale, -first[1] * scale], [-second[0] * scale, first[0] * scale]];
        (determinant > 0.0 && scale.is_finite()).then_some((Matrix { inverse, force: [along_of, across_of] }, at))
    }

    /// The end of the step with the mean velocities `x`, found by a last correction `d` from a point.
    #[inline(always)]
    fn end(&self, x: [f64; 2], d: [f64; 2], at: &Point, matrix: &Matrix) -> Option<ClosedStep<3, 1>> {
        let ([speed, w], [u0, omega0], h, half) = (x, self.start, self.h, 0.5 * self.h);
        let (m, a) = (self.sleigh.mass(), self.sleigh.offset());
        // To second order in the last turn, and to first in the force.
        let (e, [sin, cos]) = (half * d[1], at.half_turn);
        let (sin, cos) = (sin + e * (cos - 0.5 * e * sin), cos - e * (sin + 0.5 * e * cos));
        let [along, across]: [f64; 2] =
            from_fn(|i| at.force[i] + matrix.force[i][0] * d[0] + matrix.force[i][1] * d[1]);

        // The sum of the equations at the two ends gives the velocities at the second.
        let (u1, omega1) = (u0 + 2.0 * a * w * sin + 2.0 * self.gains[0] * along * cos, 2.0 * w - omega0);
        let [sin0, cos0] = self.heading;
        let (cos_m, sin_m) = (cos0 * cos - sin0 * sin, sin0 * cos + cos0 * sin);
        let (cos1, sin1) = (cos_m * cos - sin_m * sin, sin_m * cos + cos_m * sin);
        let (turn, spin) = (speed * sin, a * w * cos);
        let turns_far = (h * w).abs() > NEAR;
        let end = ClosedStep {
            increment: [h * speed * cos_m, h * speed * sin_m, h * w],
            velocity: [u1 * cos1, u1 * sin1, omega1],
            xi: [u1, omega1, 0.0],
            impulses: [
                [m * (turn + (spin - a * omega0)) - half * (across * cos + along * sin)],
                [m * (turn + (a * omega1 - spin)) - half * (across * cos - along * sin)],
            ],
            iterations: 0,
            memory: None,
        };
        (!turns_far && (u1 + omega1).is_finite()).then_some(end)
    }
}
