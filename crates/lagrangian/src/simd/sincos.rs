use super::Simd;
use crate::sincos::{COS, ROUNDER, SIN};

/// Above this, `2^50`, the number of the quadrant does not fit into the lowest bits.
const LIMIT: f64 = 1_125_899_906_842_624.0;
/// `pi/2` in two parts.
const PIO2: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];

/// Sine and cosine of the numbers in a register, within two units of `2^-53` of the truth; not a number beyond `2^50`. (No branch, so that
/// sines of the same angle are computed once.)
///
/// Written on registers, since kernels hold many of them before the compiler finds those that are the same: on packs, each would be four
/// times as long.
#[inline(always)]
pub(super) fn sin_cos<S: Simd>(s: S, x: S::f64s) -> [S::f64s; 2] {
    let known = s.select_f64s(s.less_than_f64s(s.abs_f64s(x), s.splat_f64s(LIMIT)), x, s.splat_f64s(f64::NAN));
    let rounder = s.splat_f64s(ROUNDER);
    let shifted = s.mul_add_e_f64s(x, s.splat_f64s(std::f64::consts::FRAC_2_PI), rounder);
    let n = s.sub_f64s(shifted, rounder);
    let near = s.mul_add_e_f64s(n, s.splat_f64s(-PIO2[0]), known);
    let y = s.mul_add_e_f64s(n, s.splat_f64s(-PIO2[1]), near);
    let z = s.mul_f64s(y, y);
    let zz = s.mul_f64s(z, z);
    let powers = [z, zz, s.mul_f64s(zz, zz)];
    let sin = s.mul_add_e_f64s(s.mul_f64s(y, z), polynomial(s, powers, &SIN), y);
    let start = s.mul_add_e_f64s(z, s.splat_f64s(-0.5), s.splat_f64s(1.0));
    let cos = s.mul_add_e_f64s(zz, polynomial(s, powers, &COS), start);
    // The number of the quadrant is in the lowest bits.
    let quadrant = s.transmute_u64s_f64s(shifted);
    let odd = has(s, quadrant, 1);
    [
        turned(s, s.select_f64s(odd, cos, sin), has(s, quadrant, 2)),
        turned(s, s.select_f64s(odd, sin, cos), has(s, s.add_u64s(quadrant, s.splat_u64s(1)), 2)),
    ]
}

/// The polynomial of these coefficients, from the first, second and fourth power of its variable.
#[inline(always)]
fn polynomial<S: Simd>(s: S, [z, zz, zzzz]: [S::f64s; 3], c: &[f64; 6]) -> S::f64s {
    let first = s.mul_add_e_f64s(z, s.splat_f64s(c[1]), s.splat_f64s(c[0]));
    let second = s.mul_add_e_f64s(z, s.splat_f64s(c[3]), s.splat_f64s(c[2]));
    let third = s.mul_add_e_f64s(z, s.splat_f64s(c[5]), s.splat_f64s(c[4]));
    s.mul_add_e_f64s(zzzz, third, s.mul_add_e_f64s(zz, second, first))
}

/// Whether a bit is set.
#[inline(always)]
fn has<S: Simd>(s: S, n: S::u64s, bit: u64) -> S::m64s {
    s.equal_u64s(s.and_u64s(n, s.splat_u64s(bit)), s.splat_u64s(bit))
}

/// The number with the other sign, where that is so.
#[inline(always)]
fn turned<S: Simd>(s: S, x: S::f64s, by_half: S::m64s) -> S::f64s {
    let sign = s.select_u64s(by_half, s.splat_u64s(1 << 63), s.splat_u64s(0));
    s.transmute_f64s_u64s(s.xor_u64s(s.transmute_u64s_f64s(x), sign))
}

#[cfg(test)]
mod tests {
    use crate::simd::{Kernel, Pack, Simd, dispatch};

    struct Both<'a>(&'a [f64; 8]);
    impl Kernel for Both<'_> {
        type Output = ([f64; 8], [f64; 8]);
        fn run<S: Simd, const R: usize>(self, simd: S) -> Self::Output {
            let (sin, cos) = Pack::<S, R>::load(simd, self.0).sin_cos();
            (sin.row(), cos.row())
        }
    }

    /// Two units of `2^-53`: the reduction leaves one, the polynomials one.
    #[test]
    fn agrees_with_the_platform() {
        let mut x = 1e-9f64;
        while x < 1e14 {
            let angles: [f64; 8] =
                crate::from_fn(|i| x * (1.0 + 0.137 * i as f64) * if i % 2 == 0 { 1.0 } else { -1.0 });
            let Some((sin, cos)) = dispatch(Both(&angles)) else { return };
            for i in 0..8 {
                approx::assert_abs_diff_eq!(sin[i], angles[i].sin(), epsilon = f64::EPSILON);
                approx::assert_abs_diff_eq!(cos[i], angles[i].cos(), epsilon = f64::EPSILON);
            }
            x *= 1.0173;
        }
        let beyond = dispatch(Both(&[1e16; 8]));
        assert!(beyond.is_none_or(|(sin, cos)| sin.iter().chain(&cos).all(|x| x.is_nan())));
    }
}
