use super::Pack;
use crate::sincos::{COS, SIN};
use pulp::Simd;

/// Above this, `2^50`, the number of the quadrant does not fit into the lowest bits.
const LIMIT: f64 = 1_125_899_906_842_624.0;
/// Adding it rounds to an integer, which then stands in the lowest bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
/// `pi/2` in two parts.
const PIO2: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];

impl<S: Simd, const R: usize> Pack<S, R> {
    /// Sines and cosines, within two units of `2^-53` of the truth; not a number beyond `2^50`. (No branch, so that sines of the
    /// same angle are computed once.)
    #[must_use]
    #[inline(always)]
    pub fn sin_cos(self) -> (Self, Self) {
        let simd = self.simd();
        let k = |x: f64| Self::splat(simd, x);
        let known = self
            .map(|s, x| s.select_f64s(s.less_than_f64s(s.abs_f64s(x), s.splat_f64s(LIMIT)), x, s.splat_f64s(f64::NAN)));
        let shifted = self.mul_add(k(std::f64::consts::FRAC_2_PI), k(ROUNDER));
        let n = shifted - k(ROUNDER);
        let y = n.mul_add(k(-PIO2[1]), n.mul_add(k(-PIO2[0]), known));
        let z = y * y;
        let (zz, zzzz) = (z * z, (z * z) * (z * z));
        let polynomial = |c: &[f64; 6]| {
            let pair = |i: usize| z.mul_add(k(c[i + 1]), k(c[i]));
            zzzz.mul_add(pair(4), zz.mul_add(pair(2), pair(0)))
        };
        let sin = (y * z).mul_add(polynomial(&SIN), y);
        let cos = zz.mul_add(polynomial(&COS), z.mul_add(k(-0.5), k(1.0)));
        quadrant(shifted, sin, cos)
    }
}

/// Sine and cosine from those of the angle within its quadrant, whose number is in the lowest bits of `shifted`.
#[inline(always)]
fn quadrant<S: Simd, const R: usize>(
    shifted: Pack<S, R>,
    sin: Pack<S, R>,
    cos: Pack<S, R>,
) -> (Pack<S, R>, Pack<S, R>) {
    let bits = |s: S, x: S::f64s, bit: u64, plus: u64| {
        let n = s.add_u64s(s.transmute_u64s_f64s(x), s.splat_u64s(plus));
        s.greater_than_or_equal_u64s(s.and_u64s(n, s.splat_u64s(bit)), s.splat_u64s(bit))
    };
    let flip = |s: S, down, x: S::f64s| {
        let sign = s.select_u64s(down, s.splat_u64s(1 << 63), s.splat_u64s(0));
        s.transmute_f64s_u64s(s.xor_u64s(s.transmute_u64s_f64s(x), sign))
    };
    let turned = |s: S, x: S::f64s, even: S::f64s, odd: S::f64s, plus: u64| {
        flip(s, bits(s, x, 2, plus), s.select_f64s(bits(s, x, 1, 0), odd, even))
    };
    (
        shifted.zip3(sin, cos, |s, x, sin, cos| turned(s, x, sin, cos, 0)),
        shifted.zip3(cos, sin, |s, x, cos, sin| turned(s, x, cos, sin, 1)),
    )
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
                std::array::from_fn(|i| x * (1.0 + 0.137 * i as f64) * if i % 2 == 0 { 1.0 } else { -1.0 });
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
