use dla::ClosedStepError;
use lagrangian::mul_add;
use std::f64::consts::FRAC_PI_2;

/// The series of `sin d = d + d^3 (s_0 + s_1 d^2 + ..)` and `cos d = 1 - d^2/2 + d^4 (c_0 + c_1 d^2 + ..)`.
const SINE: [f64; 5] = [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0];
const COSINE: [f64; 5] = [1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0, 1.0 / 479_001_600.0];

/// Half the turn of a step up to which three terms of the series are enough (rad), and that up to which five are.
const NARROW: f64 = 0.04;
const BROAD: f64 = 0.25;

/// Sine and cosine of half the turn of a step, which must stay below a right angle.
#[inline(always)]
pub(crate) fn half_turn(d: f64) -> Result<(f64, f64), ClosedStepError> {
    if d.abs() <= BROAD {
        Ok(series(d))
    } else if d.abs() < FRAC_PI_2 {
        Ok(d.sin_cos())
    } else {
        Err(too_far(d))
    }
}

/// Their series, to the first term below rounding: no range to reduce. No numbers where the turn is too large for these.
#[inline(always)]
pub(crate) fn series(d: f64) -> (f64, f64) {
    let z = d * d;
    if z <= NARROW * NARROW {
        summed(d, three([SINE[0], SINE[1], SINE[2]], z), three([COSINE[0], COSINE[1], COSINE[2]], z))
    } else {
        broad(d)
    }
}

// A call, since few steps come here.
#[cold]
#[inline(never)]
fn broad(d: f64) -> (f64, f64) {
    let z = d * d;
    let five = |c: &[f64; 5]| three([c[0], c[1], three([c[2], c[3], c[4]], z)], z);
    if d.abs() <= BROAD { summed(d, five(&SINE), five(&COSINE)) } else { (f64::NAN, f64::NAN) }
}

#[inline(always)]
fn three(c: [f64; 3], z: f64) -> f64 {
    mul_add(mul_add(c[2], z, c[1]), z, c[0])
}

#[inline(always)]
fn summed(d: f64, s: f64, c: f64) -> (f64, f64) {
    let z = d * d;
    (mul_add(d * z, s, d), mul_add(z, mul_add(z, c, -0.5), 1.0))
}

/// Sine and cosine of an angle and of another one: of their sum.
#[inline(always)]
pub(crate) fn turned([sin0, cos0]: [f64; 2], [sin, cos]: [f64; 2]) -> [f64; 2] {
    [mul_add(sin0, cos, cos0 * sin), mul_add(cos0, cos, -sin0 * sin)]
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
