use super::half_turn::{BROAD, COSINE, SINE};
use crate::Sleigh;
use lagrangian::simd::{Pack, Simd};

/// Half the turn of a step up to which its sine and cosine are short sums (rad); they are long ones up to `BROAD`.
const NARROW: f64 = 1.0 / 32.0;
/// With `|d| <= 1/32` the square of a correction like this is rounding.
const QUICK: f64 = 7e-8;
/// Newton's method, where it begins from the formula.
const CORRECTIONS: usize = 3;
/// With `|d| <= 1/4` the square of a correction like this is rounding.
const LAST: f64 = 8e-9;

/// The unknown ratio `r = w/omega0` of a step, with what belongs to it.
struct Ratio<P> {
    r: P,
    w: P,
    sin: P,
    cos: P,
    /// `a w sin d`.
    across: P,
    /// The last correction, relative, half the turn before it, and the whole turn after it.
    correction: P,
    turn: P,
    whole: P,
}

/// `h/2`, offset and `k = h m a / (2 J)` of the step, `u0` and `omega0` of its start.
#[derive(Clone, Copy)]
struct Equation<P> {
    half: P,
    a: P,
    k: P,
    u0: P,
    omega0: P,
}

impl<S: Simd, const R: usize> Equation<Pack<S, R>> {
    /// A first guess of `r`, that of the map of one sleigh.
    #[inline(always)]
    fn prediction(&self) -> Pack<S, R> {
        let Self { half, a, k, u0, omega0 } = *self;
        let d = half * omega0;
        let r = k.like(1.0) / (k * u0 + 1.0);
        let rr = r * r;
        r - k * ((a * omega0 + u0 * d * 0.5) * d) * (rr * rr)
    }

    /// One correction of Newton's method for `f(r) = cos d - r (cos d + k U cos d) = 0`, with its slope times `r`; what it
    /// changes is linear, to the rounding of a small one.
    #[inline(always)]
    fn corrected<const WIDE: bool>(&self, r: Pack<S, R>) -> Ratio<Pack<S, R>> {
        let Self { half, a, k, u0, omega0 } = *self;
        let w = omega0 * r;
        let turn = half * w;
        let (sin, cos) = if WIDE { long_series(turn) } else { short_series(turn) };
        let reach = a * w;
        let part = reach * sin;
        let grown = r * k.mul_add(reach.mul_add(sin, u0), cos);
        let part_of_r = reach * turn.mul_add(cos, sin);
        let slope = (-r + 1.0).mul_add(turn * sin, (k * r).mul_add(part_of_r, grown));
        let correction = (cos - grown) / slope;
        let e = turn * correction;
        let corrected = turn + e;
        Ratio {
            r: r.mul_add(correction, r),
            w: w.mul_add(correction, w),
            sin: e.mul_add(cos, sin),
            cos: (-e).mul_add(sin, cos),
            across: correction.mul_add(part_of_r, part),
            correction,
            turn,
            whole: corrected + corrected,
        }
    }
}

/// Sine and cosine to rounding for `|d| <= 1/32`.
#[inline(always)]
fn short_series<S: Simd, const R: usize>(d: Pack<S, R>) -> (Pack<S, R>, Pack<S, R>) {
    let z = d * d;
    let sin = (d * z).mul_add(z.mul_add(z.mul_add(z.like(SINE[2]), z.like(SINE[1])), z.like(SINE[0])), d);
    let cos = z.mul_add(z.mul_add(z.mul_add(z.like(COSINE[1]), z.like(COSINE[0])), z.like(-0.5)), z.like(1.0));
    (sin, cos)
}

/// The same for `|d| <= 1/4`.
#[inline(always)]
fn long_series<S: Simd, const R: usize>(d: Pack<S, R>) -> (Pack<S, R>, Pack<S, R>) {
    let z = d * d;
    let zz = z * z;
    (d + d * z * quartic(z, zz, &SINE), -(z * 0.5 - zz * quartic(z, zz, &COSINE)) + 1.0)
}

#[inline(always)]
fn quartic<S: Simd, const R: usize>(z: Pack<S, R>, zz: Pack<S, R>, c: &[f64; 5]) -> Pack<S, R> {
    (z * c[1] + c[0]) + zz * ((z * c[3] + c[2]) + zz * c[4])
}

/// What a step of eight sleighs gives; the quantities are those of [`ClosedStep`](super::ClosedStep).
#[derive(Clone, Copy)]
pub(super) struct ClosedLaneStep<P> {
    /// The increment `q1 - q0`.
    pub(super) increment: [P; 3],
    /// The quasi-velocities at the end.
    pub(super) xi: [P; 3],
    /// The frame at the end.
    pub(super) frame: [P; 6],
    /// The impulse of the blade over the step, both ends together, in its [unit](impulse_unit).
    pub(super) impulse: P,
    /// The step is good to rounding where neither of these is beyond its [bound](bounds) in size,
    pub(super) doubts: [P; 2],
    /// and this one of a wide step is positive: quick steps take over from wide ones.
    pub(super) positive: P,
}

/// The numbers of a step of length `h` (s).
pub(super) fn prepared(sleigh: &Sleigh, h: f64) -> [f64; 4] {
    [h, 0.5 * h, sleigh.offset(), 0.5 * h * sleigh.spin_gain()]
}

/// In which unit a step counts the impulse of the blade (N s): a factor that is the same in every step is left to the end of a run.
pub(super) fn impulse_unit(sleigh: &Sleigh) -> f64 {
    2.0 * sleigh.mass()
}

/// The frame at a configuration, after the frame of the step that led there; before the first step that is NaN.
#[inline(always)]
pub(super) fn frame<S: Simd, const R: usize>(q: &[Pack<S, R>; 3], before: &[Pack<S, R>; 6]) -> [Pack<S, R>; 6] {
    let (sin, cos) = q[2].sin_cos();
    [sin, cos, before[2], before[3], before[4], before[5]]
}

/// Up to which sizes of its [doubts](ClosedLaneStep::doubts) a step is good.
pub(super) fn bounds<const WIDE: bool>() -> [f64; 2] {
    if WIDE { [LAST, BROAD] } else { [QUICK, NARROW] }
}

/// One step of eight free sleighs, with the equations of the [map of one](super::free::step); nothing in it branches. A step that is not
/// `WIDE` is quicker, and good only for small changes.
///
/// A step has four numbers of the sleigh and of its length, the quasi-velocities, and a frame of six that a step leaves to the next: sine
/// and cosine of the heading, which a rotation gives cheaper than the angle does, and the ratios `w/omega0` of the last four steps, from
/// which that of the next one is extrapolated: a step then has one correction, and two divisions.
#[inline(always)]
pub(super) fn step<const WIDE: bool, S: Simd, const R: usize>(
    &[h, half, a, k]: &[Pack<S, R>; 4],
    &[u0, omega0, _]: &[Pack<S, R>; 3],
    &[sin0, cos0, r1, r2, r3, r4]: &[Pack<S, R>; 6],
) -> ClosedLaneStep<Pack<S, R>> {
    let equation = Equation { half, a, k, u0, omega0 };
    let Ratio { r, w, sin, cos, across, correction, turn, whole } = if WIDE {
        let mut r = equation.prediction();
        for _ in 1..CORRECTIONS {
            r = equation.corrected::<WIDE>(r).r;
        }
        equation.corrected::<WIDE>(r)
    } else {
        equation.corrected::<WIDE>((r1 + r3).mul_add(r1.like(4.0), (-r2).mul_add(r1.like(6.0), -r4)))
    };

    let (u1, omega1) = (u0 + (across + across), (w + w) - omega0);
    // The directions of the blade half a step and a step later; the second is the first plus a chord.
    let (cos_m, sin_m) = (cos0.mul_add(cos, -(sin0 * sin)), sin0.mul_add(cos, cos0 * sin));
    let chord = sin + sin;
    let (cos1, sin1) = ((-chord).mul_add(sin_m, cos0), chord.mul_add(cos_m, sin0));
    let mean_speed = (u0 + across) / cos;
    let (way, turned) = (h * mean_speed, mean_speed * sin);
    ClosedLaneStep {
        increment: [way * cos_m, way * sin_m, whole],
        xi: [u1, omega1, u0.like(0.0)],
        frame: [sin1, cos1, r, r1, r2, r3],
        // The impulse is m [a (omega1 - omega0) + 2 U sin d], with omega1 - omega0 = 2 (w - omega0).
        impulse: a.mul_add(w - omega0, turned),
        doubts: [correction, turn],
        positive: r,
    }
}
