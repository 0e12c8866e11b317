//! Moebius maps of the circle of headings, against series and the equation that they solve.

use crate::maps::headings::led;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;
use sleigh::planimeter::{Class, Moebius};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

type Matrix = [[f64; 2]; 2];

fn product(l: &Matrix, r: &Matrix) -> Matrix {
    [0, 1].map(|i| [0, 1].map(|j| l[i][0] * r[0][j] + l[i][1] * r[1][j]))
}

/// The power series of the exponential, to its last bit for matrices of a size below ten.
fn series(generator: &Matrix) -> Matrix {
    let (mut sum, mut term) = ([[1.0, 0.0], [0.0, 1.0]], [[1.0, 0.0], [0.0, 1.0]]);
    for n in 1..80 {
        term = product(&term, generator).map(|row| row.map(|x| x / f64::from(n)));
        sum = [0, 1].map(|i| [0, 1].map(|j| sum[i][j] + term[i][j]));
    }
    sum
}

fn assert_exponential([x, y, z]: [f64; 3]) {
    let found = Moebius::exp([x, y, z]).matrix();
    let expected = series(&[[x, y + z], [y - z, -x]]);
    // Terms up to e^size, each with a few roundings.
    let bound = 64.0 * f64::EPSILON * (x.abs() + y.abs() + z.abs()).exp();
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert_abs_diff_eq!(found, expected, epsilon = bound);
    }
}

/// The difference of two angles, full turns left out.
fn apart(a: f64, b: f64) -> f64 {
    (a - b + PI).rem_euclid(TAU) - PI
}

proptest! {
    #[test]
    fn exponentials(x in -2.0..2.0, y in -2.0..2.0, z in -2.0..2.0) {
        assert_exponential([x, y, z]);
    }

    /// A tracer on a segment and on an arc, and one after the other.
    #[test]
    fn they_lead_the_blade(
        heading in -6.0..6.0, (dx, dy) in (-1.0..1.0, -1.0..1.0), a in prop_oneof![-2.0..-0.5, 0.5..2.0f64],
        (r, from, phi) in (0.1..1.5f64, -3.0..3.0f64, -3.0..3.0f64),
    ) {
        let straight = led(|_| [dx, dy], 1.0, a, heading);
        let segment = Moebius::segment([dx, dy], a);
        assert_abs_diff_eq!(apart(segment.change(heading), straight), 0.0, epsilon = 1e-9);
        let around = |t: f64| [-r * a * phi * (from + phi * t).sin(), r * a * phi * (from + phi * t).cos()];
        let round = led(around, 1.0, a, heading);
        let arc = Moebius::arc(r, from, phi);
        assert_abs_diff_eq!(apart(arc.change(heading), round), 0.0, epsilon = 1e-9);
        let both = straight + led(around, 1.0, a, heading + straight);
        assert_abs_diff_eq!(apart((arc * segment).change(heading), both), 0.0, epsilon = 1e-9);
    }

    /// The fixed headings of a hyperbolic map stay, and the first attracts.
    #[test]
    fn fixed_headings_stay(
        (dx, dy) in (-2.0..2.0, -2.0..2.0), (r, from, turns) in (1.2..2.0, -3.0..3.0, -1i32..2), start in -3.0..3.0,
    ) {
        let map = Moebius::arc(r, from, TAU * f64::from(turns)) * Moebius::segment([dx, dy], 1.0);
        let fixed = map.fixed_headings();
        prop_assume!(map.class() == Class::Hyperbolic && map.trace() > 2.1);
        // The matrix is as large as its trace or the two headings are near each other, and its entries are rounded.
        let size = map.matrix().iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
        prop_assert_eq!(fixed.len(), 2);
        for heading in &fixed {
            assert_abs_diff_eq!(map.change(*heading), 0.0, epsilon = 1e-14 * size * size);
            prop_assert!(heading.abs() <= PI);
        }
        // A round brings the half tangents nearer by the square of the larger eigenvalue, which is above 1.3.
        let mut heading = start;
        prop_assume!(apart(start, fixed[1]).abs() > 0.01);
        for _ in 0..100 {
            heading += map.change(heading);
        }
        assert_abs_diff_eq!(apart(heading, fixed[0]), 0.0, epsilon = 1e-13 * size * size);
    }
}

/// Where the square of the matrix nearly vanishes, though the matrix does not.
#[test]
fn exponentials_near_the_cone() {
    assert_exponential([3.0, 4.0, 5.0]);
    for square in [1e-9_f64, -1e-9, 9e-9, 1.1e-8, 1e-6, -1e-6] {
        assert_exponential([0.6, 0.8, (1.0 - square).sqrt()]);
        assert_exponential([0.6, -0.8, -(1.0 - square).sqrt()]);
    }
}

#[test]
fn turns_and_their_names() {
    for angle in [0.3, -2.0, FRAC_PI_2] {
        for heading in [0.0, 1.0, -3.0] {
            assert_abs_diff_eq!(Moebius::turn(angle).change(heading), angle, epsilon = 1e-15);
        }
    }
    assert_abs_diff_eq!(Moebius::turn(4.0).change(0.5), 4.0 - TAU, epsilon = 1e-15);
    assert_eq!(Moebius::IDENTITY.change(0.7), 0.0);
    assert_eq!(Moebius::IDENTITY.trace(), 2.0);
    assert_relative_eq!(Moebius::turn(2.0 * PI).trace(), 2.0);
    assert_relative_eq!(Moebius::turn(PI / 1.5).trace(), 1.0, max_relative = 1e-15);
    assert_eq!(
        [Class::Elliptic, Class::Parabolic, Class::Hyperbolic].map(Class::name),
        ["elliptic", "parabolic", "hyperbolic"]
    );
    assert_eq!(Moebius::turn(1.0).class(), Class::Elliptic);
    assert!(Moebius::turn(1.0).fixed_headings().is_empty());
    assert_eq!(Moebius::IDENTITY.class(), Class::Parabolic);
    assert_eq!(Moebius::segment([1.0, 0.3], 1.0).class(), Class::Hyperbolic);
    // As far from the middle as the blade from its tracer: along the radius, and nowhere else.
    for from in [0.0, 1.0, -2.5] {
        let map = Moebius::arc(1.0, from, TAU);
        assert_eq!(map.class(), Class::Parabolic);
        let fixed = map.fixed_headings();
        assert_eq!(fixed.len(), 1);
        assert_abs_diff_eq!(fixed[0], from, epsilon = 1e-13);
    }
    // From far away the matrix is large, and its trace has the rounding of that.
    for [x, y] in [[6.0, 2.0], [5.1, -2.3], [-4.4, 3.7], [0.3, 6.1]] {
        let away = Moebius::segment([x, y], 1.0) * Moebius::arc(1.0, 0.7, TAU) * Moebius::segment([-x, -y], 1.0);
        assert_eq!(away.class(), Class::Parabolic);
    }
}
