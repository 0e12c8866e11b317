//! Functions at and near their corners: values, derivatives as documented, and the same on every kind of number.

use approx::assert_relative_eq;
use lagrangian::simd::{Kernel, Pack, Simd, Wide, dispatch};
use lagrangian::{Dual, Gradient, HyperDual, Lanes, Scalar};
use num_dual::HyperDual64;
use proptest::prelude::*;
use std::array::from_fn;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

type Twice<const K: usize> = HyperDual<f64, K, K>;

fn unit<const K: usize>(i: usize) -> [f64; K] {
    from_fn(|k| f64::from(u8::from(k == i)))
}

/// Numbers with both groups of derivatives in each of them.
fn seeded<const K: usize>(x: [f64; K]) -> [Twice<K>; K] {
    from_fn(|i| HyperDual::linear(x[i], unit(i), unit(i)))
}

/// Value, first and second derivatives, which are seen to be symmetric, and the first the same by every kind of number.
fn parts<const K: usize>(
    x: [f64; K],
    f: impl Fn([Twice<K>; K]) -> Twice<K>,
    once: impl Fn([Dual<f64, K>; K]) -> Dual<f64, K>,
    gradient: impl Fn([Gradient<f64, K>; K]) -> Gradient<f64, K>,
) -> (f64, [f64; K], [[f64; K]; K]) {
    let Twice { re, e1, e2, e12 } = f(seeded(x));
    assert_eq!(e1, e2);
    let once = once(from_fn(|i| Dual::variable(x[i], i)));
    let gradient = gradient(Gradient::variables(&x));
    assert_eq!((once.re, once.eps, gradient.re, gradient.gradient()), (re, e1, re, e1));
    (re, e1, e12)
}

/// A function of numbers of any kind, with its parts.
macro_rules! parts {
    (|$($x:ident),+| $f:expr; $($at:expr),+) => {
        parts([$($at),+], |[$($x),+]| $f, |[$($x),+]| $f, |[$($x),+]| $f)
    };
}

#[test]
fn of_one_number() {
    for zero in [0.0, -0.0] {
        assert_eq!(parts!(|x| x.abs(); zero), (0.0, [0.0], [[0.0]]));
        assert_eq!(parts!(|x| x.sign(); zero), (0.0, [0.0], [[0.0]]));
        // |x| x, a drag: once differentiable, and twice but for the corner.
        assert_eq!(parts!(|x| x.abs() * x; zero), (0.0, [0.0], [[0.0]]));
    }
    assert_eq!(parts!(|x| x.abs(); -1e-300), (1e-300, [-1.0], [[0.0]]));
    assert_eq!(parts!(|x| x.abs() * x; -3.0), (-9.0, [6.0], [[-2.0]]));
    assert_eq!(parts!(|x| x.sign(); -1e-300), (-1.0, [0.0], [[0.0]]));
    assert!(f64::NAN.sign().is_nan());

    // As powers have them; infinite is infinite.
    for (p, value, slope, curvature) in [
        (0.0, 1.0, 0.0, 0.0),
        (1.0, 0.0, 1.0, 0.0),
        (1.5, 0.0, 0.0, f64::INFINITY),
        (2.0, 0.0, 0.0, 2.0),
        (2.5, 0.0, 0.0, 0.0),
    ] {
        assert_eq!(parts!(|x| x.powf(p); 0.0), (value, [slope], [[curvature]]), "x^{p}");
    }
    let root = parts!(|x| x.powf(0.5); 0.0);
    assert_eq!((root.0, root.1), (0.0, [f64::INFINITY]));
    for (asin, sign) in [(parts!(|x| x.asin(); 1.0), 1.0), (parts!(|x| x.acos(); 1.0), -1.0)] {
        assert_eq!(asin.1, [sign * f64::INFINITY]);
    }
    // Far out, where 1 - tanh^2 has no digit left, and cosh is infinite.
    let (value, [slope], [[curvature]]) = parts!(|x| x.tanh(); 20.0);
    assert_relative_eq!(slope, 4.0 * (-40.0_f64).exp(), max_relative = 1e-15);
    assert_relative_eq!(curvature, -2.0 * value * slope, max_relative = 1e-15);
    assert_eq!(parts!(|x| x.tanh(); -1e4), (-1.0, [0.0], [[0.0]]));
    // 4 e^-40 by nested numbers too.
    let nested = Dual::<Dual<f64, 1>, 1>::variable(Dual::variable(0.0, 0), 0).tanh();
    assert_eq!((nested.re.eps, nested.eps[0].re, nested.eps[0].eps), ([1.0], 1.0, [0.0]));
}

/// Where two numbers are equal, the mean of both; and not-a-number is not hidden.
#[test]
fn of_two_numbers() {
    let (value, slope, curvature) = parts!(|x, y| (x * x).min(y * 2.0); 2.0, 2.0);
    assert_eq!((value, slope, curvature), (4.0, [2.0, 1.0], [[1.0, 0.0], [0.0, 0.0]]));
    assert_eq!(parts!(|x, y| (x * x).max(y * 2.0); 2.0, 2.0), (value, slope, curvature));
    assert_eq!(parts!(|x, y| x.max(y * 0.0); 0.0, 1.0), (0.0, [0.5, 0.0], [[0.0; 2]; 2]));
    assert_eq!(parts!(|x, y| x.min(y); 1.0, 1.0 + f64::EPSILON), (1.0, [1.0, 0.0], [[0.0; 2]; 2]));
    assert_eq!(parts!(|x, y| x.max(y); 1.0, f64::INFINITY), (f64::INFINITY, [0.0, 1.0], [[0.0; 2]; 2]));
    for [x, y] in [[f64::NAN, 1.0], [1.0, f64::NAN]] {
        assert!(Scalar::min(x, y).is_nan() && Scalar::max(x, y).is_nan());
    }
    for x in [f64::MAX, f64::INFINITY, -f64::MAX, f64::NEG_INFINITY] {
        assert_eq!((Scalar::min(x, x), Scalar::max(x, x), Scalar::max(x, 0.0)), (x, x, f64::max(x, 0.0)));
    }
    // What is not chosen may be anything.
    let chosen = parts!(|x, y| x.where_positive(x * y, (x - x).sqrt()); 2.0, 3.0);
    assert_eq!(chosen, (6.0, [3.0, 2.0], [[0.0, 1.0], [1.0, 0.0]]));
}

#[test]
fn of_vectors() {
    // At the corner zero, alone and in a drag; and for any direction off it as documented.
    for zero in [0.0, -0.0] {
        let none = (0.0, [0.0; 2], [[0.0; 2]; 2]);
        assert_eq!(parts!(|x, y| Scalar::length(&[x, y]); zero, zero), none);
        assert_eq!(parts!(|x, y| x * Scalar::length(&[x, y]); zero, zero), none);
        let (angle, slope, curvature) = parts!(|x, y| y.atan2(x); zero, zero);
        assert_eq!((angle, slope, curvature), (zero.atan2(zero), none.1, none.2));
    }
    assert_eq!(parts!(|x, y| Scalar::length(&[x, y]); 3.0, 4.0).0, 5.0);
    for scale in [1e-300, 1e-200, 1e-20, 1.0, 1e20, 1e200, 1e300] {
        let (r, [ex, ey], [[exx, exy], [eyx, eyy]]) = parts!(|x, y| Scalar::length(&[x, y]); 3.0 * scale, -4.0 * scale);
        for (part, right) in [
            (r / scale, 5.0),
            (ex, 0.6),
            (ey, -0.8),
            (exx * scale, 0.64 / 5.0),
            (eyy * scale, 0.36 / 5.0),
            (exy * scale, 0.48 / 5.0),
            (eyx * scale, 0.48 / 5.0),
        ] {
            assert_relative_eq!(part, right, max_relative = 4.0 * f64::EPSILON);
        }
    }
    for scale in [1e-150, 1e-20, 1.0, 1e20, 1e150] {
        let (angle, [ax, ay], [[axx, axy], [_, ayy]]) = parts!(|x, y| y.atan2(x); -3.0 * scale, 4.0 * scale);
        assert_eq!(angle, 4.0_f64.atan2(-3.0));
        for (part, right) in [
            (ax * scale, -4.0 / 25.0),
            (ay * scale, -3.0 / 25.0),
            (axx * scale * scale, -24.0 / 625.0),
            (ayy * scale * scale, 24.0 / 625.0),
            (axy * scale * scale, 7.0 / 625.0),
        ] {
            assert_relative_eq!(part, right, max_relative = 8.0 * f64::EPSILON);
        }
    }
    // One number is its absolute value, and straight; the smallest numbers keep their size; across the cut the slope is finite.
    assert_eq!(parts!(|x| Scalar::length(&[x]); -1e-7), (1e-7, [-1.0], [[0.0]]));
    let least = f64::from_bits(3);
    assert_eq!(parts!(|x, y| Scalar::length(&[x, y]); least, 0.0), (least, [1.0, 0.0], [[0.0; 2]; 2]));
    assert_eq!(parts!(|x, y| y.atan2(x); -2.0, 0.0), (PI, [0.0, -0.5], [[0.0, -0.25], [-0.25, 0.0]]));
    assert_eq!(f64::length(&[f64::NAN, f64::INFINITY]).to_bits() << 1, f64::NAN.to_bits() << 1);
    assert_eq!((f64::length(&[f64::INFINITY, 1.0]), f64::length::<0>(&[])), (f64::INFINITY, 0.0));
    for (y, x, angle) in [(1.0, 0.0, FRAC_PI_2), (1.0, 1.0, FRAC_PI_4), (-0.0, -1.0, -PI)] {
        assert_eq!(Dual::<f64, 1>::constant(y).atan2(Dual::constant(x)).re, angle);
    }
}

/// A number, often at or near a corner of something.
fn near_corners() -> impl Strategy<Value = f64> {
    let exponent = -300..300i32;
    let power = (any::<bool>(), exponent).prop_map(|(minus, e)| if minus { -1.0 } else { 1.0 } * 10f64.powi(e));
    prop_oneof![Just(0.0), Just(1.0), Just(-1.0), -2.0..2.0f64, power]
}

/// All that has a corner or a pole.
fn cornered<S: Scalar>(x: S, y: S) -> [S; 11] {
    [
        x.abs(),
        x.sign(),
        x.min(y),
        x.max(y),
        S::length(&[x, y]),
        y.atan2(x),
        x.tanh(),
        x.powf(2.0),
        x.where_positive(x, y),
        x.abs().sqrt(),
        x.recip() - S::constant(1.5),
    ]
}

/// Told apart from what all have in common, and not.
struct InRegisters<'a>([&'a [f64; 8]; 2]);

impl Kernel for InRegisters<'_> {
    type Output = [[[f64; 8]; 11]; 2];
    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> [[[f64; 8]; 11]; 2] {
        let [x, y] = self.0.map(|row| Pack::<S, R>::load(simd, row));
        [cornered(Wide::Each(x), Wide::Each(y)).map(|x| x.pack(simd).row()), cornered(x, y).map(|x| x.row())]
    }
}

/// The same with one number of the two in common, and with both.
struct InCommon<'a>(&'a [f64; 8], f64);

impl Kernel for InCommon<'_> {
    type Output = [[[f64; 8]; 11]; 3];
    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> [[[f64; 8]; 11]; 3] {
        let (x, y) = (Wide::Each(Pack::<S, R>::load(simd, self.0)), Wide::Same(self.1));
        [cornered(x, y), cornered(y, Wide::zero()), cornered(Wide::zero(), y)]
            .map(|all| all.map(|x| x.pack(simd).row()))
    }
}

proptest! {
    /// Eight numbers side by side give the bits of each by itself.
    #[test]
    fn on_lanes_and_in_registers(
        x in proptest::array::uniform8(near_corners()), y in proptest::array::uniform8(near_corners()),
    ) {
        let lanes = cornered(Lanes(x), Lanes(y));
        let (Some(registers), Some([one, two, three])) = (dispatch(InRegisters([&x, &y])), dispatch(InCommon(&x, y[0])))
        else {
            return Ok(());
        };
        for l in 0..8 {
            let alone = cornered(x[l], y[l]);
            let common = [cornered(x[l], y[0]), cornered(y[0], 0.0), cornered(0.0, y[0])];
            for (k, right) in alone.iter().enumerate() {
                let all = [lanes[k].0[l], registers[0][k][l], registers[1][k][l]];
                prop_assert!(all.iter().all(|x| x.to_bits() == right.to_bits()), "{k}: {all:?} for {right}");
                let all = [one[k][l], two[k][l], three[k][l]];
                prop_assert!((0..3).all(|i| all[i] == common[i][k]), "{k}: {all:?}");
            }
        }
    }

    /// Whatever the numbers, every derivative that is documented to be finite at a corner is finite.
    #[test]
    fn derivatives_are_finite(x in near_corners(), y in near_corners()) {
        let [x, y] = seeded([x, y]);
        // The second derivatives of an angle are 1/r^2, and leave the range of numbers before r does.
        let near = f64::length(&[x.re, y.re]);
        let length = Scalar::length(&[x, y]);
        let angle = if (1e-150..1e150).contains(&near) { y.atan2(x) } else { y };
        for f in [x.abs(), x.sign(), x.min(y), x.max(y), length, angle, x * length] {
            let all = f.e1.iter().chain(&f.e2).chain(f.e12.as_flattened()).all(|x| x.is_finite());
            prop_assert!(all, "{f:?} at {} and {}", x.re, y.re);
        }
    }

    /// As near to a corner as `num-dual` can go: length and angle against its root of squares and its quotient.
    #[test]
    fn near_a_corner(scale in -60..60i32, x in 0.1..1.0f64, y in -1.0..1.0f64) {
        let scale = 10f64.powi(scale);
        let [ours_x, ours_y] = seeded([x * scale, y * scale]);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let seed = |value: f64, k: usize| {
                HyperDual64::new(value * scale, f64::from(u8::from(i == k)), f64::from(u8::from(j == k)), 0.0)
            };
            let oracle = (seed(x, 0), seed(y, 1));
            // In units of the derivatives, r/r and r/r^2, or 1/r and 1/r^2. Sums of terms of that size, each rounded a few times.
            for (ours, right, size) in [
                (Scalar::length(&[ours_x, ours_y]), HyperDual64::length(&[oracle.0, oracle.1]), 1.0),
                (ours_y.atan2(ours_x), oracle.1.atan2(oracle.0), scale.recip()),
            ] {
                let apart = [
                    ours.re - right.re,
                    (ours.e1[i] - right.eps1) * scale,
                    (ours.e12[i][j] - right.eps1eps2) * scale * scale,
                ];
                let bound = 1e-12 * size * scale;
                prop_assert!(apart.iter().all(|x| x.abs() <= bound), "{apart:?} for {bound}");
            }
        }
    }
}
