use super::{Pack, Simd};
use scalar::sincos::{COS, ROUNDER, SIN};

/// Above this, `2^50`, the number of the quadrant does not fit into the lowest bits.
const LIMIT: f64 = 1_125_899_906_842_624.0;
/// `pi/2` in two parts.
const PIO2: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];

impl<S: Simd, const R: usize> Pack<S, R> {
    /// Sines and cosines, within two units of `2^-53` of the truth; not a number beyond `2^50`. (No branch, so that sines of the
    /// same angle are computed once.)
    #[must_use]
    #[inline(always)]
    pub fn sin_cos(self) -> (Self, Self) {
        let simd = self.simd();
        let known = self.map(
            #[inline(always)]
            |s, x| within(s, x),
        );
        let rounder = Self::splat(simd, ROUNDER);
        let shifted = self.mul_add(Self::splat(simd, std::f64::consts::FRAC_2_PI), rounder);
        let n = shifted - rounder;
        let y = n.mul_add(Self::splat(simd, -PIO2[1]), n.mul_add(Self::splat(simd, -PIO2[0]), known));
        let z = y * y;
        let (zz, zzzz) = (z * z, (z * z) * (z * z));
        let sin = (y * z).mul_add(polynomial([z, zz, zzzz], &SIN), y);
        let cos =
            zz.mul_add(polynomial([z, zz, zzzz], &COS), z.mul_add(Self::splat(simd, -0.5), Self::splat(simd, 1.0)));
        (
            shifted.zip3(
                sin,
                cos,
                #[inline(always)]
                |s, x, sin, cos| turned(s, x, [sin, cos], 0),
            ),
            shifted.zip3(
                cos,
                sin,
                #[inline(always)]
                |s, x, cos, sin| turned(s, x, [cos, sin], 1),
            ),
        )
    }
}

/// The angle; NaN if it is too large for the number of its quadrant to be known.
#[inline(always)]
fn within<S: Simd>(s: S, x: S::f64s) -> S::f64s {
    s.select_f64s(s.less_than_f64s(s.abs_f64s(x), s.splat_f64s(LIMIT)), x, s.splat_f64s(f64::NAN))
}

/// The polynomial of these coefficients, from the first, second and fourth power of its variable.
#[inline(always)]
fn polynomial<S: Simd, const R: usize>([z, zz, zzzz]: [Pack<S, R>; 3], c: &[f64; 6]) -> Pack<S, R> {
    let k = z.simd();
    let pair = [
        z.mul_add(Pack::splat(k, c[1]), Pack::splat(k, c[0])),
        z.mul_add(Pack::splat(k, c[3]), Pack::splat(k, c[2])),
        z.mul_add(Pack::splat(k, c[5]), Pack::splat(k, c[4])),
    ];
    zzzz.mul_add(pair[2], zz.mul_add(pair[1], pair[0]))
}

/// Sine or cosine of an angle, from sine and cosine of its part within a quadrant. The lowest bits of `shifted` hold the number of the
/// quadrant; `plus` is 0 for the sine and 1 for the cosine, which is the sine one quadrant on.
#[inline(always)]
fn turned<S: Simd>(s: S, shifted: S::f64s, [even, odd]: [S::f64s; 2], plus: u64) -> S::f64s {
    let value = s.select_f64s(has(s, shifted, 1, 0), odd, even);
    let sign = s.select_u64s(has(s, shifted, 2, plus), s.splat_u64s(1 << 63), s.splat_u64s(0));
    s.transmute_f64s_u64s(s.xor_u64s(s.transmute_u64s_f64s(value), sign))
}

/// Whether a bit is set in the lowest bits, taken as a number and increased.
#[inline(always)]
fn has<S: Simd>(s: S, x: S::f64s, bit: u64, plus: u64) -> S::m64s {
    let n = s.add_u64s(s.transmute_u64s_f64s(x), s.splat_u64s(plus));
    s.equal_u64s(s.and_u64s(n, s.splat_u64s(bit)), s.splat_u64s(bit))
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
