//! Eight lanes against eight scalars, and their sine and cosine against the platform's.

use crate::common::{Everything, vector};
use lagrangian::simd::{Kernel, Pack, Simd, Square, Wide, dispatch};
use lagrangian::{Dual, HyperDual, Lanes, Scalar, System, momentum, vectorized};
use proptest::prelude::*;
use std::array::from_fn;

fn lane_sin_cos(x: f64) -> (f64, f64) {
    let (sin, cos) = Lanes::constant(x).sin_cos();
    (sin.0[3], cos.0[3])
}

/// The product of a matrix, by its columns, with a vector.
struct Product<'a> {
    columns: &'a [[f64; 8]; 8],
    x: &'a [f64; 8],
}

impl Kernel for Product<'_> {
    type Output = [f64; 8];
    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> [f64; 8] {
        let terms = Square::of_columns(self.columns).terms.map(|term| Pack::<S, R>::load(simd, &term));
        Pack::load(simd, self.x).times(&terms).row()
    }
}

/// The sum of a row.
struct Folded<'a>(&'a [f64; 8]);

impl Kernel for Folded<'_> {
    type Output = f64;
    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> f64 {
        Pack::<S, R>::load(simd, self.0).folded()
    }
}

/// Whether zero and a number that all places have in common, carried as a row is, are rows of it; and stay what they are
/// beside one that is none.
struct CarriedAs<'a>(&'a [f64; 8]);

impl Kernel for CarriedAs<'_> {
    type Output = [bool; 3];
    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> [bool; 3] {
        let row = Wide::Each(Pack::<S, R>::load(simd, self.0));
        let in_all =
            |x: Wide<S, R>, value: f64| matches!(x, Wide::Each(x) if x.row().map(f64::to_bits) == [value.to_bits(); 8]);
        [
            in_all(Wide::Zero.carried_as(row), 0.0),
            in_all(Wide::Same(self.0[0]).carried_as(row), self.0[0]),
            matches!(Wide::<S, R>::Zero.carried_as(Wide::Same(1.0)), Wide::Zero),
        ]
    }
}

/// What a kernel gives by every instruction set that the machine has, whichever of them `dispatch` takes.
fn by_every_set<K: Kernel>(kernel: impl Fn() -> K) -> Vec<K::Output> {
    let mut all = Vec::from_iter(dispatch(kernel()));
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::x86::{V3, V4};
        all.extend(V3::try_new().map(|simd| simd.vectorize(|| kernel().run::<_, 2>(simd))));
        all.extend(V4::try_new().map(|simd| simd.vectorize(|| kernel().run::<_, 1>(simd))));
    }
    all
}

proptest! {
    /// What a number is carried as does not change it.
    #[test]
    fn numbers_carried_as_rows(x in vector::<8>()) {
        prop_assert!(by_every_set(|| CarriedAs(&x)).iter().all(|kept| *kept == [true; 3]));
    }

    /// A row and its mirror image have one sum, to the last bit.
    #[test]
    fn sums_in_registers(x in vector::<8>()) {
        let mirrored = from_fn(|i| x[7 - i]);
        // Seven roundings on either side, of sums no larger than this one.
        let epsilon = 7.0 * f64::EPSILON * x.iter().map(|x| x.abs()).sum::<f64>();
        for (sum, same) in by_every_set(|| Folded(&x)).into_iter().zip(by_every_set(|| Folded(&mirrored))) {
            prop_assert_eq!(sum.to_bits(), same.to_bits());
            approx::assert_abs_diff_eq!(sum, x.iter().sum::<f64>(), epsilon = epsilon);
        }
    }

    /// A matrix in the order of registers is the same matrix; and where it is its own mirror image, the product with a mirrored row
    /// is the mirrored product, to the last bit.
    #[test]
    fn products_in_registers(columns in proptest::array::uniform8(vector::<8>()), x in vector::<8>()) {
        for product in by_every_set(|| Product { columns: &columns, x: &x }) {
            for i in 0..8 {
                let terms: [f64; 8] = from_fn(|j| columns[j][i] * x[j]);
                // Eight roundings at most on either side, of sums no larger than this one.
                let epsilon = 16.0 * f64::EPSILON * terms.iter().map(|t| t.abs()).sum::<f64>();
                approx::assert_abs_diff_eq!(product[i], terms.iter().sum::<f64>(), epsilon = epsilon);
            }
        }
        let symmetric = from_fn(|j| from_fn(|i| if j < 4 { columns[j][i] } else { columns[7 - j][7 - i] }));
        let mirrored = from_fn(|i| x[7 - i]);
        let products = by_every_set(|| Product { columns: &symmetric, x: &x });
        for (product, other) in products.iter().zip(by_every_set(|| Product { columns: &symmetric, x: &mirrored })) {
            prop_assert!((0..8).all(|i| product[i].to_bits() == other[7 - i].to_bits()));
        }
    }

    /// The same model on lanes gives what it gives on f64 to the rounding of sine and cosine, and the same bits whether it
    /// runs on the machine's best instructions or on the build's own.
    #[test]
    fn lanes_are_eight_scalars(
        c in vector(), t in vector::<8>(), q in proptest::array::uniform8(vector::<3>()),
        v in proptest::array::uniform8(vector::<3>()),
    ) {
        let system = Everything { c };
        let lane_q: [Lanes; 3] = from_fn(|i| Lanes(from_fn(|l| q[l][i])));
        let lane_v: [Lanes; 3] = from_fn(|i| Lanes(from_fn(|l| v[l][i])));
        let plain = system.lagrangian(Lanes(t), &lane_q, &lane_v);
        let wide = vectorized(#[inline(always)] || system.lagrangian(Lanes(t), &lane_q, &lane_v));
        let p = vectorized(#[inline(always)] || momentum(&system, Lanes(t), &lane_q, &lane_v));
        for l in 0..8 {
            let scalar = system.lagrangian(t[l], &q[l], &v[l]);
            prop_assert_eq!(wide.0[l].to_bits(), plain.0[l].to_bits());
            approx::assert_relative_eq!(plain.0[l], scalar, epsilon = 1e-14, max_relative = 1e-14);
            for i in 0..3 {
                let expected = momentum(&system, t[l], &q[l], &v[l])[i];
                approx::assert_relative_eq!(p[i].0[l], expected, epsilon = 1e-14, max_relative = 1e-14);
            }
        }
    }

    /// Second derivatives over lanes: the type that eight trajectories will solve with.
    #[test]
    fn duals_over_lanes(x in vector::<8>(), y in vector::<8>()) {
        let f = |a: HyperDual<Lanes, 1, 1>, b: HyperDual<Lanes, 1, 1>| (a * b).sin() / (b * b + 2.0).sqrt();
        let lanes = f(
            HyperDual::linear(Lanes(x), [Lanes::constant(1.0)], [Lanes::zero()]),
            HyperDual::linear(Lanes(y), [Lanes::zero()], [Lanes::constant(1.0)]),
        );
        for l in 0..8 {
            let a = Dual::<Dual<f64, 1>, 1>::variable(Dual::fixed(x[l]), 0);
            let b = Dual::fixed(Dual::variable(y[l], 0));
            let nested = (a * b).sin() / (b * b + 2.0).sqrt();
            approx::assert_relative_eq!(lanes.e12[0][0].0[l], nested.eps[0].eps[0], epsilon = 1e-14);
        }
    }

    #[test]
    fn sine_and_cosine_within_an_ulp(x in prop_oneof![
        -1.0..1.0f64, -1e4..1e4f64, -1e6..1e6f64, -1e300..1e300f64,
        // Near the multiples of pi/2, where a careless reduction loses everything.
        (-100_000i32..100_000, -1e-9..1e-9f64).prop_map(|(k, e)| f64::from(k) * std::f64::consts::FRAC_PI_2 + e),
    ]) {
        let (sin, cos) = lane_sin_cos(x);
        for (ours, platform) in [(sin, f64::sin(x)), (cos, f64::cos(x))] {
            // Both are within one unit in the last place of the truth.
            let ulp = (platform.abs() * f64::EPSILON).max(f64::MIN_POSITIVE);
            prop_assert!((ours - platform).abs() <= 2.0 * ulp, "{x}: {ours} and {platform}");
        }
    }
}

#[test]
fn sine_and_cosine_of_special_values() {
    assert_eq!(lane_sin_cos(0.0), (0.0, 1.0));
    assert!(lane_sin_cos(-0.0).0.is_sign_negative());
    assert_eq!(lane_sin_cos(1e-300), (1e-300, 1.0));
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (sin, cos) = lane_sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan());
    }
}
