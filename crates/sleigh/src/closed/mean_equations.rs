use super::form::{brake, push};
use super::half_turn::{half_turn, turned};
use crate::Sleigh;
use dla::KnownAngle;
use lagrangian::{Dual, Effect, from_fn, mul_add};

/// The equations of a step of the pushed map for its mean velocities `U` and `w`; here what does not change with these.
pub(crate) struct MeanEquations<'a> {
    sleigh: &'a Sleigh,
    t: f64,
    pub(crate) h: f64,
    q: &'a [f64; 3],
    /// `u0`, `omega0`.
    pub(crate) start: [f64; 2],
    /// Sine and cosine of the heading at the beginning.
    heading: [f64; 2],
    /// `h/(2m)`, `h/(2J)`, `k`.
    gains: [f64; 3],
}

/// What the equations are at one point.
#[derive(Clone, Copy)]
pub(crate) struct MeanPoint {
    /// By how much they are missed.
    pub(crate) missing: [f64; 2],
    /// The sums of the sizes of their terms.
    pub(crate) terms: [f64; 2],
    /// Sine and cosine of `d`.
    pub(crate) half_turn: [f64; 2],
    /// `f_e`, `f_n`.
    pub(crate) force: [f64; 2],
}

/// Their derivatives in `U` and `w`.
#[derive(Clone, Copy)]
pub(crate) struct Matrix {
    adjugate: [[f64; 2]; 2],
    determinant: f64,
    /// The derivatives of `f_e`, `f_n`.
    pub(crate) force: [[f64; 2]; 2],
}

impl Matrix {
    /// The velocities with Newton's correction, and that alone.
    #[inline(always)]
    pub(crate) fn corrected(&self, x: [f64; 2], [a, b]: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let d: [f64; 2] = from_fn(|i| mul_add(self.adjugate[i][0], a, self.adjugate[i][1] * b) / self.determinant);
        (from_fn(|i| x[i] + d[i]), d)
    }

    /// Whether the determinant, one for a step of length zero, has its sign.
    #[inline(always)]
    pub(crate) fn keeps_sign(&self) -> bool {
        self.determinant > 0.0 && self.determinant < f64::INFINITY
    }
}

impl<'a> MeanEquations<'a> {
    /// The equations of a step of length `h` (s) from the time `t` (s), the configuration `q` with this sine and cosine of the heading,
    /// and the velocities `start`.
    #[inline(always)]
    pub(crate) fn new(
        sleigh: &'a Sleigh,
        (t, h): (f64, f64),
        (q, heading): (&'a [f64; 3], [f64; 2]),
        start: [f64; 2],
    ) -> Self {
        let half = 0.5 * h;
        let gains = [half / sleigh.mass(), half / sleigh.pivot_inertia(), half * sleigh.spin_gain()];
        Self { sleigh, t, h, q, start, heading, gains }
    }

    /// The middle of the step: sine and cosine of its heading, which is the heading of the chord, and the configuration.
    #[inline(always)]
    fn middle(&self, [speed, w]: [f64; 2], half_turn: [f64; 2]) -> ([f64; 2], [f64; 3]) {
        let half = 0.5 * self.h;
        let (way, chord) = (half * speed, turned(self.heading, half_turn));
        let [x, y, heading] = *self.q;
        (chord, [mul_add(way, chord[1], x), mul_add(way, chord[0], y), mul_add(half, w, heading)])
    }

    #[inline(always)]
    fn point(&self, [speed, w]: [f64; 2], half_turn: [f64; 2], chord: [f64; 2], [fx, fy, tau]: [f64; 3]) -> MeanPoint {
        let ([u0, omega0], [sin, cos], a) = (self.start, half_turn, self.sleigh.offset());
        let [of_mass, of_inertia, k] = self.gains;
        let force @ [along, across] = [mul_add(chord[1], fx, chord[0] * fy), mul_add(chord[1], fy, -chord[0] * fx)];
        let [carried, turned] = [speed * cos, a * w * sin];
        let (pushed, grown) = (mul_add(along, cos, -across * sin), w * mul_add(k, speed, 1.0));
        // The force is what takes longest.
        let missing = [mul_add(-of_mass, pushed, (carried - turned) - u0), mul_add(-of_inertia, tau, grown - omega0)];
        let [pushed, torque] = [of_mass * pushed, of_inertia * tau];
        MeanPoint {
            missing,
            terms: [carried.abs() + turned.abs() + u0.abs() + pushed.abs(), grown.abs() + omega0.abs() + torque.abs()],
            half_turn,
            force,
        }
    }

    /// The equations at the velocities `x`; none where the blade would turn by a right angle in half the step, or the force is not
    /// known by hand.
    #[inline(always)]
    pub(crate) fn at<E: Effect<Sleigh, 3>>(&self, effects: &E, x: [f64; 2]) -> Option<MeanPoint> {
        let half_turn = half_turn(0.5 * self.h * x[1]).ok()?.into();
        let (chord, [qx, qy, heading]) = self.middle(x, half_turn);
        let heading = KnownAngle::new(heading, chord[0], chord[1]);
        let t = KnownAngle::from(self.t + 0.5 * self.h);
        let q = [KnownAngle::from(qx), KnownAngle::from(qy), heading];
        let force = push(effects, self.sleigh, t, &q, &[x[0] * chord[1], x[0] * chord[0], x[1]].map(KnownAngle::from))?;
        Some(self.point(x, half_turn, chord, force.map(|f| f.re)))
    }

    /// Whether the force at the end differs from that at the mean velocities `x`, both in the middle of the step, by more than the
    /// inertia between the two: as a brake does that turns the velocity round.
    ///
    /// What differs by rounding is no brake. The general step has the same question, of any system.
    #[inline(always)]
    pub(crate) fn overshoots<E: Effect<Sleigh, 3>>(
        &self,
        effects: &E,
        (x, half_turn): ([f64; 2], [f64; 2]),
        ([u1, omega1], [sin1, cos1]): ([f64; 2], [f64; 2]),
    ) -> bool {
        /// A change of the velocity by a smaller part of it (squared) is compared with rounding.
        const ROUNDING: f64 = 1e-16;
        let ([sin, cos], [qx, qy, heading]) = self.middle(x, half_turn);
        let ([speed, w], known) = (x, KnownAngle::from);
        let (mean, end) = ([speed * cos, speed * sin, w], [u1 * cos1, u1 * sin1, omega1]);
        let (t, q) = (known(self.t + 0.5 * self.h), [known(qx), known(qy), KnownAngle::new(heading, sin, cos)]);
        let at = |v: &[f64; 3]| brake(effects, self.sleigh, t, &q, &v.map(known));
        let Some((of_mean, of_end)) = at(&mean).zip(at(&end)) else { return false };
        let [dx, dy, turned]: [f64; 3] = from_fn(|i| end[i] - mean[i]);
        let damping = 0.5
            * self.h
            * [dx, dy, turned].iter().enumerate().map(|(i, d)| d * (of_mean[i].re - of_end[i].re)).sum::<f64>();
        let inertia = |x: f64, y: f64, omega: f64| {
            let (m, a, j) = (self.sleigh.mass(), self.sleigh.offset(), self.sleigh.pivot_inertia());
            m * (x * x + y * y) + (2.0 * m * a * (cos * y - sin * x) + j * omega) * omega
        };
        let between = inertia(dx, dy, turned);
        damping > between && between > ROUNDING * inertia(mean[0], mean[1], w)
    }

    /// The equations with their derivatives, where sine and cosine of the half turn are known.
    #[inline(always)]
    pub(crate) fn linearised<E: Effect<Sleigh, 3>>(
        &self,
        effects: &E,
        x: [f64; 2],
        half_turn: [f64; 2],
    ) -> Option<(Matrix, MeanPoint)> {
        let (chord, [qx, qy, heading]) = self.middle(x, half_turn);
        let ([speed, w], half) = (x, 0.5 * self.h);
        let way = half * speed;
        let seeded = |re: KnownAngle, eps: [f64; 2]| Dual { re, eps: eps.map(KnownAngle::from) };
        let q = [
            seeded(KnownAngle::from(qx), [half * chord[1], -half * way * chord[0]]),
            seeded(KnownAngle::from(qy), [half * chord[0], half * way * chord[1]]),
            seeded(KnownAngle::new(heading, chord[0], chord[1]), [0.0, half]),
        ];
        let v = [
            seeded(KnownAngle::from(speed * chord[1]), [chord[1], -way * chord[0]]),
            seeded(KnownAngle::from(speed * chord[0]), [chord[0], way * chord[1]]),
            seeded(KnownAngle::from(w), [0.0, 1.0]),
        ];
        let force = push(effects, self.sleigh, Dual::fixed(KnownAngle::from(self.t + half)), &q, &v)?;
        let at = self.point(x, half_turn, chord, force.map(|f| f.re.re));

        let ([sin, cos], [along, across]) = (half_turn, at.force);
        let (a, [of_mass, of_inertia, k]) = (self.sleigh.offset(), self.gains);
        let [fx, fy, tau] = force.map(|f| f.eps.map(|x| x.re));
        // The chord turns by half a step's turn.
        let of_both = |[x, y]: [[f64; 2]; 2]| {
            let along: [f64; 2] = from_fn(|i| mul_add(chord[1], x[i], chord[0] * y[i]));
            let across: [f64; 2] = from_fn(|i| mul_add(chord[1], y[i], -chord[0] * x[i]));
            (along, across)
        };
        let (mut along_of, mut across_of) = of_both([fx, fy]);
        along_of[1] = mul_add(half, across, along_of[1]);
        across_of[1] = mul_add(-half, along, across_of[1]);
        let pushed: [f64; 2] = from_fn(|i| mul_add(along_of[i], cos, -across_of[i] * sin));
        let pushed = [pushed[0], mul_add(-half, mul_add(along, sin, across * cos), pushed[1])];
        let first = [
            mul_add(-of_mass, pushed[0], cos),
            mul_add(-of_mass, pushed[1], -mul_add(way, sin, a * mul_add(half * w, cos, sin))),
        ];
        let second = [mul_add(-of_inertia, tau[0], k * w), mul_add(-of_inertia, tau[1], mul_add(k, speed, 1.0))];
        let determinant = mul_add(first[0], second[1], -first[1] * second[0]);
        let adjugate = [[-second[1], first[1]], [second[0], -first[0]]];
        Some((Matrix { adjugate, determinant, force: [along_of, across_of] }, at))
    }
}
