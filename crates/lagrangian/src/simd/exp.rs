use super::{Pack, Simd};
use scalar::sincos::ROUNDER;

/// `ln 2` in two parts.
const LN2: [f64; 2] = [std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17];
/// `1/k!`: on `[-ln(2)/2, ln(2)/2]` the first term left out is below `2^-57`.
const TERMS: [f64; 14] = [
    1.0,
    1.0,
    0.5,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

impl<S: Simd, const R: usize> Pack<S, R> {
    /// The exponentials, within two units of `2^-53` of the truth, and of the least number there is where that is larger.
    ///
    /// With `n` the integer nearest to `x/ln(2)`: `exp(x) = 2^n exp(x - n ln(2))`, the latter by its power series.
    #[must_use]
    #[inline(always)]
    pub fn exp(self) -> Self {
        let simd = self.simd();
        // Beyond, the result is zero or infinite; what is not a number stays none.
        let x = self.map(
            #[inline(always)]
            |s, x| {
                let (low, high) = (s.splat_f64s(-746.0), s.splat_f64s(710.0));
                let x = s.select_f64s(s.greater_than_f64s(x, high), high, x);
                s.select_f64s(s.less_than_f64s(x, low), low, x)
            },
        );
        let rounder = Self::splat(simd, ROUNDER);
        let n = x.mul_add(Self::splat(simd, std::f64::consts::LOG2_E), rounder) - rounder;
        let r = n.mul_add(Self::splat(simd, -LN2[1]), n.mul_add(Self::splat(simd, -LN2[0]), x));
        // In two factors, each of which is a number where the product is none or loses digits.
        let first = n.mul_add(Self::splat(simd, 0.5), rounder);
        let second = (n - (first - rounder)) + rounder;
        series(r) * power_of_two(first) * power_of_two(second)
    }
}

/// The power series, its terms taken in pairs: fewer operations wait for one another.
#[inline(always)]
fn series<S: Simd, const R: usize>(r: Pack<S, R>) -> Pack<S, R> {
    let (r2, r4) = (r * r, (r * r) * (r * r));
    let low = r4.mul_add(r2.mul_add(pair(r, 6), pair(r, 4)), r2.mul_add(pair(r, 2), pair(r, 0)));
    let high = r4.mul_add(pair(r, 12), r2.mul_add(pair(r, 10), pair(r, 8)));
    (r4 * r4).mul_add(high, low)
}

/// The coefficients of `r^k` and of `r^(k+1)` as one factor of `r^k`.
#[inline(always)]
fn pair<S: Simd, const R: usize>(r: Pack<S, R>, k: usize) -> Pack<S, R> {
    r.mul_add(r.like(TERMS[k + 1]), r.like(TERMS[k]))
}

/// `2^k` of the integer `k` in the lowest bits.
#[inline(always)]
fn power_of_two<S: Simd, const R: usize>(k: Pack<S, R>) -> Pack<S, R> {
    k.map(
        #[inline(always)]
        |s, k| s.transmute_f64s_u64s(s.as_exponent(s.add_u64s(s.transmute_u64s_f64s(k), s.splat_u64s(1023)))),
    )
}

#[cfg(test)]
mod tests {
    use crate::simd::{Kernel, Pack, Simd, dispatch};

    struct Exponentials([f64; 8]);
    impl Kernel for Exponentials {
        type Output = [f64; 8];
        fn run<S: Simd, const R: usize>(self, simd: S) -> [f64; 8] {
            Pack::<S, R>::load(simd, &self.0).exp().row()
        }
    }

    /// Two units of `2^-53`: one of the reduction and the series, one of rounding the product; and where numbers lose digits the least of them.
    #[test]
    fn agrees_with_the_platform() {
        let mut x = -750.0f64;
        while x < 715.0 {
            let at: [f64; 8] = crate::from_fn(|i| x + 0.0137 * i as f64);
            let Some(found) = dispatch(Exponentials(at)) else { return };
            for i in 0..8 {
                let (expected, least) = (at[i].exp(), f64::from_bits(1));
                approx::assert_relative_eq!(found[i], expected, max_relative = 2.0 * f64::EPSILON, epsilon = least);
            }
            x += 0.1119;
        }
        let ends = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e300, -1e300, 1e-300];
        let Some([none, rest @ ..]) = dispatch(Exponentials(ends)) else { return };
        assert!(none.is_nan());
        let expected = [f64::INFINITY, 0.0, 1.0, 1.0, f64::INFINITY, 0.0, 1.0];
        assert_eq!(rest.map(f64::to_bits), expected.map(f64::to_bits));
    }
}
