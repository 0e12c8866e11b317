//! The closed form against reference values of many digits.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use sleigh::{Exact, Sleigh, SleighError, SleighState};

/// `golden/exact.py` writes it and says how.
const GOLDEN: &str = include_str!("golden/exact.txt");

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().map(|word| word.parse().unwrap()).collect()
}

/// The inputs are exact and the outputs correctly rounded, so these are errors of [`Exact`] alone.
#[test]
fn golden_values() {
    let rows = GOLDEN.lines().filter(|line| !line.starts_with('#'));
    for row in rows {
        let (inputs, outputs) = row.split_once('|').unwrap();
        let [m, inertia, a, x, y, heading, speed, turn_rate, t] = numbers(inputs)[..] else { panic!("{row}") };
        let [x1, y1, theta, u, omega, length] = numbers(outputs)[..] else { panic!("{row}") };
        let sleigh = Sleigh::new(m, inertia, a).unwrap();
        let start = SleighState { x, y, heading, speed, turn_rate };
        let end = Exact::new(&sleigh, &start).unwrap().at(t);

        // Some ten roundings. The last line of the path has the direction of the heading, which has a rounding for each
        // radian: a relative error of the path, as is that of a coordinate which is large itself.
        let rounding = 8.0 * f64::EPSILON;
        let turn = (theta - heading).abs();
        let total_speed = speed.hypot((sleigh.pivot_inertia() / m).sqrt() * turn_rate);
        let path = rounding * (length * (1.0 + turn.min(1e3) / 8.0) + x1.abs().max(y1.abs()) / 8.0);
        let close = |name: &str, ours: f64, reference: f64, tolerance: f64| {
            let error = (ours - reference).abs();
            assert!(error <= tolerance, "{name}: {ours:e}, not {reference:e}, off by {error:e} > {tolerance:e}: {row}");
        };
        close("x", end.x, x1, path);
        close("y", end.y, y1, path);
        close("theta", end.heading, theta, rounding * turn + f64::EPSILON * theta.abs());
        close("u", end.speed, u, rounding * total_speed);
        close("omega", end.turn_rate, omega, rounding * omega.abs());
    }
}

/// `m = a = 1, I = 3, U = 0.8`, from the turning point: the elementary case `sigma = 2`.
#[test]
fn the_elementary_case() {
    let sleigh = Sleigh::new(1.0, 3.0, 1.0).unwrap();
    let end = Exact::new(&sleigh, &SleighState { turn_rate: 0.4, ..SleighState::default() }).unwrap().at(10.0);
    // ell int tan(phi) e^(2 i phi) dphi from 0, ell = 4.
    let phi: f64 = 2.0 * (1.0_f64).tanh().atan();
    let half = 0.5_f64;
    assert_relative_eq!(end.x, 4.0 * (phi.cos().ln() - half * (2.0 * phi).cos() + half), max_relative = 1e-14);
    assert_relative_eq!(end.y, 4.0 * (phi - half * (2.0 * phi).sin()), max_relative = 1e-14);
    assert_relative_eq!(end.heading, 2.0 * phi, max_relative = 1e-14);
    // The same as numbers of 15 digits.
    assert_relative_eq!(end.x, -1.58261428884412, max_relative = 4e-15);
    assert_relative_eq!(end.y, 4.18207862641735, max_relative = 4e-15);
    assert_relative_eq!(end.heading, 2.60352067209203, max_relative = 4e-15);
    assert_relative_eq!(end.speed, 0.771222064060654, max_relative = 4e-15);
    assert_relative_eq!(end.turn_rate, 0.106320891533632, max_relative = 8e-15);
}

/// `m = I = 1, a = 1/2`, given at the centre of mass: `(X, Y, theta, u, omega) = (0, 0, 0, 1, 0.3)`, ten seconds.
#[test]
fn a_run_of_the_centre_of_mass() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let start = SleighState { x: -0.5, speed: 1.0, turn_rate: 0.3, ..SleighState::default() };
    let end = Exact::new(&sleigh, &start).unwrap().at(10.0);
    let (sin, cos) = end.heading.sin_cos();
    // The reference has 16 digits; the result a few roundings of a path of length 10.
    assert_abs_diff_eq!(end.x + 0.5 * cos, 8.630050962159051, epsilon = 1e-14);
    assert_abs_diff_eq!(end.y + 0.5 * sin, 5.777081619895769, epsilon = 1e-14);
    assert_relative_eq!(end.heading, 0.7128922085503294, max_relative = 1e-15);
    assert_relative_eq!(end.speed, 1.054738987164179, max_relative = 1e-15);
    assert_relative_eq!(end.turn_rate, 0.004531574197290071, max_relative = 1e-15);
}

/// Of a balanced sleigh both velocities are constant, to the last bit.
#[test]
fn balanced_is_a_circle() {
    let (u, omega) = (1.5, -0.7);
    let sleigh = Sleigh::new(2.0, 0.5, 0.0).unwrap();
    let motion = Exact::new(&sleigh, &SleighState { speed: u, turn_rate: omega, ..SleighState::default() }).unwrap();
    assert!(motion.turning_angle().is_infinite());
    for t in [-1e5, -3.0, 1e-9, 1.0, 15.0, 1e6] {
        let end = motion.at(t);
        assert_eq!((end.speed.to_bits(), end.turn_rate.to_bits()), (u.to_bits(), omega.to_bits()));
        // On the circle of radius |u/omega| about (0, u/omega), with the blade along its tangent.
        let radius = u / omega;
        let tolerance = 4.0 * f64::EPSILON * (u * t).abs().max(radius.abs());
        assert_abs_diff_eq!(end.x, radius * end.heading.sin(), epsilon = tolerance);
        assert_abs_diff_eq!(end.y, radius * (1.0 - end.heading.cos()), epsilon = tolerance);
    }
}

#[test]
fn without_spin_the_line_is_straight() {
    let sleigh = Sleigh::new(2.0, 0.5, 0.3).unwrap();
    let start = SleighState { x: 1.0, y: -2.0, heading: 0.5, speed: -1.5, turn_rate: 0.0 };
    let motion = Exact::new(&sleigh, &start).unwrap();
    let end = motion.at(-8.0);
    let expected = SleighState { x: 1.0 + 12.0 * 0.5_f64.cos(), y: -2.0 + 12.0 * 0.5_f64.sin(), ..start };
    assert_eq!(end, expected);
    assert_eq!(motion.turning_angle().to_bits(), 0.0_f64.to_bits());

    let rest = Exact::new(&sleigh, &SleighState { speed: 0.0, ..start }).unwrap();
    assert_eq!(rest.at(1e9), SleighState { speed: 0.0, ..start });
}

/// Backwards with a spin of `1e-300`: the time of the flip is `t = ln(2 Omega/omega0)/kappa`, `Omega = U/k`, and there
/// `u = 0` and `omega = Omega`.
#[test]
fn the_flip_comes_at_its_time() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let start = SleighState { speed: -1.0, turn_rate: -1e-300, ..SleighState::default() };
    let motion = Exact::new(&sleigh, &start).unwrap();
    let (kappa, most) = (0.4, 1.25_f64.sqrt().recip());
    let flip = motion.at((2.0_f64.ln() + most.ln() + 300.0 * 10.0_f64.ln()) / kappa);
    // The argument is a sum near 690, of half a unit of 1.1e-13 in each of three roundings.
    assert_abs_diff_eq!(flip.speed, 0.0, epsilon = 2e-13);
    assert_relative_eq!(flip.turn_rate, -most, max_relative = 1e-15);
    assert_abs_diff_eq!(flip.heading, -0.5 * motion.turning_angle(), epsilon = 5e-13);
}

#[test]
fn what_is_not_finite_is_named() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let good = SleighState { speed: 1.0, turn_rate: 1.0, ..SleighState::default() };
    let cases = [
        ("x", SleighState { x: f64::NAN, ..good }),
        ("y", SleighState { y: f64::INFINITY, ..good }),
        ("heading", SleighState { heading: f64::NEG_INFINITY, ..good }),
        ("speed", SleighState { speed: f64::NAN, ..good }),
        ("turn rate", SleighState { turn_rate: f64::INFINITY, ..good }),
    ];
    for (name, start) in cases {
        let Err(SleighError::NotFinite { quantity, value }) = Exact::new(&sleigh, &start) else { panic!("{name}") };
        assert_eq!(quantity, name);
        assert!(!value.is_finite());
    }
    let huge = SleighState { speed: f64::MAX, turn_rate: f64::MAX, ..good };
    assert!(matches!(Exact::new(&sleigh, &huge), Err(SleighError::NotFinite { .. })));
}

/// Faster by a power of two and shorter by the same is the same path to the last bit, also where squares of the velocities have
/// left the range of numbers.
#[test]
fn time_has_no_scale() {
    let sleigh = Sleigh::new(1.3, 0.7, 0.45).unwrap();
    for (speed, turn_rate) in [(-0.7, 0.3), (0.9, -1.1), (0.0, 0.6)] {
        let start =
            |scale: f64| SleighState { speed: speed * scale, turn_rate: turn_rate * scale, ..SleighState::default() };
        for t in [0.3, 7.0, 70.0, 200.0] {
            let usual = Exact::new(&sleigh, &start(1.0)).unwrap().at(t);
            for power in [-540, 540] {
                let scale = 2.0_f64.powi(power);
                let end = Exact::new(&sleigh, &start(scale)).unwrap().at(t / scale);
                let scaled = SleighState { speed: end.speed / scale, turn_rate: end.turn_rate / scale, ..end };
                assert_eq!(scaled, usual, "{power} {t}");
            }
        }
    }
}
