//! The generated rules are exact where they should be.

use approx::assert_relative_eq;
use lagrangian::Twofold;
use lagrangian::quadrature::{gauss_collocation, gauss_legendre, gauss_legendre_twofold};

/// Sums of up to 16 terms below one.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

fn check<const S: usize>() {
    let (c, b) = gauss_legendre::<S>();
    assert!(c.windows(2).all(|pair| pair[0] < pair[1]));
    for degree in 0..2 * S {
        let sum: f64 = (0..S).map(|i| b[i] * c[i].powi(degree as i32)).sum();
        assert_relative_eq!(sum, 1.0 / (degree as f64 + 1.0), epsilon = ROUNDING);
    }
    // Not one degree more: the rule is the one it says, and the check can fail.
    let sum: f64 = (0..S).map(|i| b[i] * c[i].powi(2 * S as i32)).sum();
    let exact = 1.0 / (2.0 * S as f64 + 1.0);
    if S < 8 {
        assert!((sum - exact).abs() > 1e-12, "S = {S}: {sum}");
    }
    let a = gauss_collocation(&c, &b);
    for i in 0..S {
        for degree in 0..S {
            let sum: f64 = (0..S).map(|j| a[i][j] * c[j].powi(degree as i32)).sum();
            let power = degree as f64 + 1.0;
            assert_relative_eq!(sum, c[i].powf(power) / power, epsilon = ROUNDING);
        }
        // The adjoint of the method is itself.
        for j in 0..S {
            let (one, other) = (Twofold::from(a[i][j]), Twofold::from(a[S - 1 - i][S - 1 - j]));
            let left = one + other - Twofold::from(b[j]);
            assert_eq!((left.hi, left.lo), (0.0, 0.0), "S = {S}, {i}, {j}");
        }
    }
}

#[test]
fn gauss_rules_integrate_polynomials() {
    check::<1>();
    check::<2>();
    check::<3>();
    check::<4>();
    check::<5>();
    check::<6>();
    check::<7>();
    check::<8>();
    check::<16>();
}

/// Twice the digits: powers are integrated to some 100 bits.
#[test]
fn twofold_rules() {
    fn check<const S: usize>() {
        let (c, b) = gauss_legendre_twofold::<S>();
        let mut powers = b;
        for degree in 0..2 * S {
            let sum = powers.iter().fold(Twofold::from(0.0), |sum, term| sum + *term);
            let missing = sum - Twofold::from(1.0) / Twofold::from(degree as f64 + 1.0);
            assert!(missing.hi.abs() <= 1e-30, "S = {S}, degree {degree}: {missing:?}");
            powers = std::array::from_fn(|i| powers[i] * c[i]);
        }
        // The control: without the second halves the sums are those of f64.
        if S > 2 {
            let sum = (0..S).fold(Twofold::from(0.0), |sum, i| sum + Twofold::product(b[i].hi, c[i].hi));
            assert!((sum - Twofold::from(0.5)).hi.abs() > 1e-19);
        }
    }
    check::<1>();
    check::<2>();
    check::<3>();
    check::<4>();
    check::<8>();
    check::<16>();
}

#[test]
fn published_values() {
    let (c, b) = gauss_legendre::<2>();
    assert_relative_eq!(c[0], 0.5 - 3f64.sqrt() / 6.0, epsilon = ROUNDING);
    assert_relative_eq!(b[0], 0.5, epsilon = ROUNDING);
    let a = gauss_collocation(&c, &b);
    assert_relative_eq!(a[0][1], 0.25 - 3f64.sqrt() / 6.0, epsilon = ROUNDING);
    assert_relative_eq!(a[1][0], 0.25 + 3f64.sqrt() / 6.0, epsilon = ROUNDING);
    let (c, b) = gauss_legendre::<3>();
    assert_relative_eq!(c[2], 0.5 + 15f64.sqrt() / 10.0, epsilon = ROUNDING);
    assert_relative_eq!(b[1], 4.0 / 9.0, epsilon = ROUNDING);
}
