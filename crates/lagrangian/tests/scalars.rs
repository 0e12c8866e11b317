//! Arrays that are filled place by place, and sines of wrapped angles.

use approx::assert_abs_diff_eq;
use scalar::{from_fn, sin_cos_wrapped};
use std::f64::consts::{FRAC_PI_2, PI};

/// With a closure that has a state: it is called once for each index, in order.
#[test]
fn places_are_those_of_the_standard_library() {
    fn same<const N: usize>() {
        let remembering = || {
            let mut sum = 1;
            move |i: usize| {
                sum = 3 * sum + i;
                sum
            }
        };
        let expected: [usize; N] = std::array::from_fn(remembering());
        assert_eq!(from_fn::<_, N, _>(remembering()), expected);
    }
    same::<0>();
    same::<1>();
    same::<2>();
    same::<7>();
}

/// Two units of `2^-53`: the reduction leaves one, the polynomials one; to all digits where the sine or cosine is small.
#[test]
fn of_a_wrapped_angle() {
    let near = [0.0, FRAC_PI_2, PI].into_iter().flat_map(|x| (0..60).map(move |i| x * (1.0 - 1e-3 * 0.6f64.powi(i))));
    let far = [1e-300, 4.0, 1e3, 1e300].into_iter();
    for x in near.chain(far).chain((0..4000).map(|i| 1e-3 * f64::from(i))).flat_map(|x| [x, -x]) {
        let (sin, cos) = sin_cos_wrapped(x);
        assert_abs_diff_eq!(sin, x.sin(), epsilon = f64::EPSILON * x.sin().abs());
        assert_abs_diff_eq!(cos, x.cos(), epsilon = f64::EPSILON * x.cos().abs());
    }
    for x in [f64::NAN, f64::INFINITY] {
        assert!(sin_cos_wrapped(x).0.is_nan() && sin_cos_wrapped(x).1.is_nan());
    }
}
