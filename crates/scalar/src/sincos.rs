//! Sine and cosine of several numbers at once, without branches, so that loops over lanes become vector instructions.
//!
//! Reduction by Cody and Waite in three parts of `pi/2`, then the polynomials of the FreeBSD mathematics library
//! (`k_sin.c`, `k_cos.c`, Sun Microsystems 1993) on `[-pi/4, pi/4]`. No fused operations, so that every machine gives
//! the same bits; but for [`sin_cos_wrapped`].

use crate::mul_add;

/// Above this the product of the quadrant's number with the first part of `pi/2` is no longer exact.
const LIMIT: f64 = 1.0e6;
const TWO_OVER_PI: f64 = std::f64::consts::FRAC_2_PI;
/// Adding it rounds to an integer, which then stands in the lowest bits of the sum.
pub const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
/// `pi/2`, its first 33 bits, the next 33 bits, and the rest.
const PIO2: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

/// The polynomial of the sine on `[-pi/4, pi/4]`.
pub const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
/// The polynomial of the cosine there.
pub const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sines and cosines of `x` (rad).
#[inline(always)]
pub fn sin_cos<const W: usize>(x: &[f64; W]) -> ([f64; W], [f64; W]) {
    let mut sin = [0.0; W];
    let mut cos = [0.0; W];
    let mut far = false;
    for i in 0..W {
        far |= x[i].abs() > LIMIT;
        (sin[i], cos[i]) = reduced(x[i]);
    }
    if far {
        for i in 0..W {
            (sin[i], cos[i]) = x[i].sin_cos();
        }
    }
    (sin, cos)
}

/// Sine and cosine of an angle (rad), with an error of at most two units of `2^-53`. For angles within half a turn they are inlined
/// polynomials with fused operations, and no call.
#[must_use]
#[inline(always)]
pub fn sin_cos_wrapped(x: f64) -> (f64, f64) {
    // Up to two quadrants, whose product with the first part of `pi/2` is exact.
    const PARTS: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];
    if x.abs() <= std::f64::consts::PI {
        let shifted = mul_add(x, TWO_OVER_PI, ROUNDER);
        let k = shifted - ROUNDER;
        let y = mul_add(-k, PARTS[1], mul_add(-k, PARTS[0], x));
        let z = y * y;
        let sum = |c: &[f64; 6]| (0..5).rev().fold(c[5], |sum, i| mul_add(sum, z, c[i]));
        let sin = mul_add(y * z, sum(&SIN), y);
        let cos = mul_add(z * z, sum(&COS), mul_add(z, -0.5, 1.0));
        turned(sin, cos, shifted.to_bits())
    } else {
        x.sin_cos()
    }
}

/// Sine and cosine of an angle, from sine and cosine of its part within a quadrant. The lowest bits of `quadrant` hold the quadrant's
/// number.
#[inline(always)]
fn turned(sin: f64, cos: f64, quadrant: u64) -> (f64, f64) {
    let odd = quadrant & 1 != 0;
    let (s, c) = (if odd { cos } else { sin }, if odd { sin } else { cos });
    let sign_sin = (quadrant & 2) << 62;
    let sign_cos = (quadrant.wrapping_add(1) & 2) << 62;
    (f64::from_bits(s.to_bits() ^ sign_sin), f64::from_bits(c.to_bits() ^ sign_cos))
}

#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    let shifted = x * TWO_OVER_PI + ROUNDER;
    let quadrant = shifted.to_bits();
    let k = shifted - ROUNDER;

    // y + tail = x - k pi/2, good to some 118 bits.
    let t = x - k * PIO2[0];
    let w = k * PIO2[1];
    let r = t - w;
    let w = k * PIO2[2] - ((t - r) - w);
    let y = r - w;
    let tail = (r - y) - w;

    let z = y * y;
    let p = SIN[1] + z * (SIN[2] + z * (SIN[3] + z * (SIN[4] + z * SIN[5])));
    let sin = y - ((z * (0.5 * tail - z * y * p) - tail) - z * y * SIN[0]);
    let p = z * (COS[0] + z * (COS[1] + z * (COS[2] + z * (COS[3] + z * (COS[4] + z * COS[5])))));
    let half = 0.5 * z;
    let one = 1.0 - half;
    let cos = one + (((1.0 - one) - half) + (z * p - y * tail));

    turned(sin, cos, quadrant)
}
