//! Functions of time.

use approx::assert_relative_eq;
use lagrangian::{Dual, Piecewise};
use proptest::prelude::*;
use sleigh::effects::{MovingMass, Thrust, Torque};
use sleigh::{Flywheel, Formula, Guide, Guided, Pulses, Ramp, Sleigh, SleighError, Table, TimeFunction};
use std::f64::consts::{PI, TAU};

fn steps() -> TimeFunction {
    TimeFunction::Table(Table::new(vec![1.0, 2.5, 4.0], vec![0.5, -0.7, 0.2]).unwrap())
}

proptest! {
    #[test]
    fn a_slope_is_the_derivative_of_the_value(
        t in -5.0..5.0f64, amplitude in -2.0..2.0f64, frequency in -3.0..3.0f64, phase in -4.0..4.0f64,
    ) {
        let sine = TimeFunction::Sine { amplitude, frequency, phase };
        // A sine within two units of 2^-53, and products of it and of the platform's.
        let expected = amplitude * (frequency * t + phase).sin();
        assert_relative_eq!(sine.value(t), expected, max_relative = 2.0 * f64::EPSILON, epsilon = 0.0);
        for function in [sine, TimeFunction::Constant(amplitude), steps()] {
            let value = function.value(Dual::<f64, 1>::variable(t, 0));
            prop_assert_eq!(value.re, function.value(t));
            // A product of three, rounded in either order.
            assert_relative_eq!(value.eps[0], function.slope(t), max_relative = 4.0 * f64::EPSILON, epsilon = 1e-300);
            let slope = function.slope(Dual::<f64, 1>::variable(t, 0));
            assert_relative_eq!(slope.eps[0], -frequency * frequency * function.value(t)
                * f64::from(u8::from(matches!(function, TimeFunction::Sine { .. }))), epsilon = 1e-14);
            assert_relative_eq!(slope.eps[0], function.curvature(t), epsilon = 1e-14);
        }
    }
}

/// A value holds from its time on, the first also before.
#[test]
fn a_table_in_pieces() {
    let table = steps();
    for (t, value) in [(-9.0, 0.5), (1.0, 0.5), (2.4, 0.5), (2.5, -0.7), (3.9, -0.7), (4.0, 0.2), (1e9, 0.2)] {
        let piece = table.piece(t);
        assert_eq!(piece.value(t), value, "at {t}");
        // A piece is the same at all times.
        assert_eq!(piece.value(-100.0), value);
    }
    assert_eq!(table.value(100.0), 0.5);
    assert_eq!(table.jumps(-10.0, 10.0), [2.5, 4.0]);
    // Not at the ends, nor where the table begins.
    assert_eq!(table.jumps(2.5, 4.0), [0.0; 0]);
    assert_eq!(table.jumps(0.0, 3.0), [2.5]);
    let sine = TimeFunction::Sine { amplitude: 1.0, frequency: 2.0, phase: 0.0 };
    assert!(sine.jumps(-10.0, 10.0).is_empty() && sine.piece(3.0) == sine);
}

/// Lines from point to point, and the values at the ends beyond them.
#[test]
fn ramps_in_pieces() {
    let ramps = TimeFunction::Ramp(Ramp::new(vec![1.0, 2.5, 4.0], vec![0.5, -1.0, 0.5]).unwrap());
    for (t, value, slope) in
        [(-9.0, 0.5, 0.0), (1.0, 0.5, -1.0), (2.0, -0.5, -1.0), (2.5, -1.0, 1.0), (3.5, 0.0, 1.0), (9.0, 0.5, 0.0)]
    {
        let piece = ramps.piece(t);
        assert_eq!((piece.value(t), piece.slope(t)), (value, slope), "at {t}");
        // A piece goes on beyond its ends.
        assert_eq!(piece.value(t + 10.0), value + 10.0 * slope);
    }
    assert_eq!(ramps.jumps(-10.0, 10.0), [1.0, 2.5, 4.0]);
    let steep = Ramp::new(vec![0.0, 1e-300], vec![0.0, 1e300]);
    assert!(matches!(&steep, Err(SleighError::Table { problem }) if problem.contains("too steep")), "{steep:?}");
}

/// A formula and its derivatives, on every number that carries derivatives.
#[test]
fn formulas() {
    let formula = TimeFunction::Formula(Formula::new("0.4*t*exp(-t)").unwrap());
    type Second = Dual<Dual<f64, 1>, 1>;
    for t in [0.0, 0.7, 3.0] {
        let x = Second { re: Dual::variable(t, 0), eps: [Dual { re: 1.0, eps: [0.0] }] };
        let found = formula.value(x);
        let decay = 0.4 * f64::exp(-t);
        let expected = [t * decay, (1.0 - t) * decay, (t - 2.0) * decay];
        for (found, expected) in [found.re.re, found.eps[0].re, found.eps[0].eps[0]].into_iter().zip(expected) {
            // Sums of two products, and the rounding of the exponential.
            assert_relative_eq!(found, expected, max_relative = 8.0 * f64::EPSILON, epsilon = 1e-16);
        }
        assert_relative_eq!(formula.slope(t), expected[1], max_relative = 8.0 * f64::EPSILON, epsilon = 1e-16);
    }
    assert!(formula.jumps(-10.0, 10.0).is_empty() && formula.piece(3.0) == formula);
    let refused = |text: &str, said: &str| {
        let error = Formula::new(text).unwrap_err().to_string();
        assert!(error.contains(said), "{text}: {error}");
    };
    refused("0.2*x", "no name `x`");
    refused("0.2*", "column");
    refused("1/t", "its value at t = 0 is");
    let long: Vec<String> = (1..400).map(|k| format!("sin({k}*t)*cos({k}.5*t^{k})")).collect();
    let nested = long.iter().fold("t".to_owned(), |inner, term| format!("sin({inner} + {term})"));
    assert!(Formula::new(&nested).is_err());
}

/// Between their corners formulas are smooth, and go on as they are.
#[test]
fn formulas_in_pieces() {
    let waves = TimeFunction::Formula(Formula::new("max(0, sin(t)) - 2*sign(t - 4)").unwrap());
    let jumps = waves.jumps(0.0, 7.0);
    assert_eq!((jumps.len(), jumps[1]), (3, 4.0));
    assert!((jumps[0] - PI).abs() < 1e-15 && (jumps[2] - TAU).abs() < 2e-15);
    for (from, value) in [(1.0, 3.0), (3.5, 2.0), (4.5, -2.0), (6.5, f64::sin(2.0) - 2.0)] {
        let piece = waves.piece(from);
        // Half the sum and half the difference of two.
        assert_relative_eq!(piece.value(if from == 1.0 { 0.5 * PI } else { 2.0 }), value, max_relative = f64::EPSILON);
    }
    let piece = waves.piece(1.0);
    assert_eq!([piece.value(0.0), piece.slope(0.0)], [2.0, 1.0]);
    assert_relative_eq!(piece.curvature(PI + 0.5), f64::sin(0.5), max_relative = 4.0 * f64::EPSILON);
    // As a whole it is what it says.
    assert_eq!([1.0, 4.0, 5.0].map(|t| waves.value(t)), [f64::sin(1.0) + 2.0, 0.0, -2.0]);
    for corner in ["abs(sin(t))", "sign(t - 3)", "min(t, 5)"] {
        let refused = MovingMass::new(1.0, TimeFunction::Formula(Formula::new(corner).unwrap()), 0.0);
        assert!(matches!(refused, Err(SleighError::Formula { .. })), "{corner}");
    }
    assert!(MovingMass::new(1.0, TimeFunction::Formula(Formula::new("max(0, 2 + sin(t))").unwrap()), 0.0).is_ok());
}

/// Formulas are checked in a time that grows with their length, and derivatives of any order are there for who asks.
#[test]
fn long_formulas_are_as_good_as_short_ones() {
    let nested = format!("{}t{}", "sin(".repeat(250), ")".repeat(250));
    let texts = [
        "tanh(10*sin(3*t))*exp(-t/10)/(1+t^2)",
        "tanh(sin(sqrt(1+t^2)))/(1+exp(-cos(t)))",
        "tanh(tanh(tanh(tanh(t))))",
        "1/(1+1/(1+1/(1+1/(1+t^2))))",
        &nested,
    ];
    type Third = Dual<Dual<Dual<f64, 1>, 1>, 1>;
    for text in texts {
        let formula = TimeFunction::Formula(Formula::new(text).unwrap());
        let third = |t: f64| {
            let first = Dual::variable(t, 0);
            let second = Dual { re: first, eps: [Dual::fixed(1.0)] };
            formula.value(Third { re: second, eps: [Dual::fixed(Dual::fixed(1.0))] }).eps[0].eps[0].eps[0]
        };
        // Against a central difference of the second derivative, whose error is some h^2 and 1e-16/h.
        let (h, t) = (1e-5, 0.7);
        let difference = (formula.curvature(t + h) - formula.curvature(t - h)) / (2.0 * h);
        assert_relative_eq!(third(t), difference, max_relative = 1e-4, epsilon = 1e-6);
    }
}

/// What has a table jumps with it.
#[test]
fn jumps_come_through() {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let jumps = [2.5, 4.0];
    let thrust = Thrust::new(steps()).unwrap();
    assert!(thrust.jumps(0.0, 9.0) == jumps && thrust.piece(3.0) != thrust);
    assert_eq!(Torque::new(steps()).unwrap().jumps(0.0, 9.0), jumps);
    let flywheel = Flywheel::new(sleigh, 0.2, Some(steps())).unwrap();
    assert_eq!(flywheel.jumps(0.0, 9.0), jumps);
    assert_eq!(flywheel.piece(3.0).torque().unwrap().value(0.0), -0.7);
    assert!(Flywheel::new(sleigh, 0.2, None).unwrap().jumps(0.0, 9.0).is_empty());
    let servo = Guided::<1>::servo(sleigh, Guide::Speed(steps())).unwrap();
    assert!(servo.piece(3.0) != servo && servo.piece(1.5) == servo);
    assert_eq!(Flywheel::new(servo, 0.2, Some(steps())).unwrap().jumps(0.0, 3.0), [2.5, 2.5]);
    assert!(Guided::turntable(sleigh, 0.3).unwrap().jumps(0.0, 9.0).is_empty());
}

/// Two pulses, of 1.5 s and of 0.5 s.
fn pulses() -> TimeFunction {
    TimeFunction::Pulses(Pulses::new(vec![1.0, 2.5, 3.0], vec![0.6, -0.4]).unwrap())
}

proptest! {
    #[test]
    fn pulses_are_raised_cosines(t in -1.0..5.0f64) {
        // The first holds before it begins as well; after the last there is nothing.
        let (begin, length, area) = if t < 2.5 { (1.0, 1.5, 0.6) } else { (2.5, 0.5, -0.4) };
        let on = f64::from(u8::from(t < 3.0));
        let (k, x) = (TAU / length, TAU * (t - begin) / length);
        let piece = pulses().piece(t);
        assert_relative_eq!(piece.value(t), on * area / length * (1.0 - x.cos()), epsilon = 1e-14);
        let value = piece.value(Dual::<f64, 1>::variable(t, 0));
        // Slopes are below forty and their arguments below twenty.
        assert_relative_eq!(value.eps[0], on * area / length * k * x.sin(), epsilon = 1e-12);
        assert_relative_eq!(value.eps[0], piece.slope(t), epsilon = 1e-12);
        // Its integral over each pulse, by a sum of equal steps, which is exact for a cosine.
        let mean = |from: f64, to: f64| (0..8).map(|k| {
            let t = from + (to - from) * f64::from(k) / 8.0;
            pulses().piece(t).value(t)
        }).sum::<f64>() / 8.0;
        assert_relative_eq!(mean(1.0, 2.5) * 1.5, 0.6, epsilon = 1e-14);
        assert_relative_eq!(mean(2.5, 3.0) * 0.5, -0.4, epsilon = 1e-14);
    }
}

#[test]
fn pulses_in_pieces() {
    let pulses = pulses();
    for (t, at) in [(0.0, 1.75), (1.0, 1.75), (2.4, 1.75), (2.5, 2.75), (2.9, 2.75)] {
        let height = if at < 2.0 { 2.0 * 0.6 / 1.5 } else { -2.0 * 0.4 / 0.5 };
        assert_relative_eq!(pulses.piece(t).value(at), height, max_relative = 1e-15);
    }
    for t in [3.0, 9.0] {
        assert_eq!((pulses.piece(t).value(2.75), pulses.piece(t).slope(2.6)), (0.0, 0.0));
    }
    // The seams, and the last end; where the first begins nothing changes.
    assert_eq!(pulses.jumps(0.0, 9.0), [2.5, 3.0]);
    assert_eq!(pulses.jumps(2.5, 3.0), [0.0; 0]);
    assert_eq!(pulses.jumps(1.0, 2.6), [2.5]);
    assert_eq!(pulses.jumps(2.6, 3.1), [3.0]);
    for (times, areas) in [(vec![0.0, 1.0], vec![]), (vec![0.0], vec![1.0]), (vec![1.0, 0.5], vec![1.0])] {
        assert!(matches!(Pulses::new(times, areas), Err(SleighError::Table { .. })));
    }
}
