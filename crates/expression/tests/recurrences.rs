//! The Taylor series of solutions: against derivatives of every function, against solutions that are known, and at corners.

use crate::common::{built, expression, off_corners};
use expression::{Expansion, Function, Graph, MOST_ORDERS, Names, Recurrences, Series, Tape, parse};
use proptest::prelude::*;

/// The recurrences of `x' = rate` for each text, in the unknowns `x`, `y` (variables 1 and 2) and time.
fn recurrences(rates: &[&str]) -> Recurrences {
    let names = Names::of(["t", "x", "y"]).unwrap();
    let mut graph = Graph::new();
    let meanings: Vec<_> = (0..3).map(|k| graph.variable(k)).collect();
    let rates: Vec<_> =
        rates.iter().map(|text| graph.build(&parse(text, &names).unwrap(), &meanings).unwrap()).collect();
    let variables: Vec<u32> = (1..=rates.len() as u32).collect();
    Recurrences::new(&graph, &rates, &variables).unwrap()
}

fn expanded(of: &Recurrences, t: f64, x: &[f64], unit: f64, order: usize) -> Expansion<f64> {
    let mut series = Expansion::new(of);
    series.expand(of, (t, x, &[]), unit, order);
    series
}

/// The derivatives of a formula of time (`x`) and of three linear functions of time, by the recurrences of `r' = f` and by the arithmetic of
/// truncated series.
fn same_derivatives(text: &str, from: [f64; 4]) {
    let mut graph = Graph::new();
    let rates = [-0.7, 0.4, 0.2];
    let mut all: Vec<_> = rates.iter().map(|rate| graph.constant(*rate)).collect();
    all.push(built(&mut graph, text));
    let of = Recurrences::new(&graph, &all, &[1, 2, 3, 4]).unwrap();
    let series = expanded(&of, from[0], &[from[1], from[2], from[3], 0.0], 1.0, 7);

    let tape = Tape::new(&graph, &all[3..]).unwrap();
    let (mut scratch, mut value) = (vec![Series::variable(0.0); tape.scratch()], [Series::variable(0.0)]);
    let t = Series::variable(0.0);
    let inputs = [t + from[0], t * rates[0] + from[1], t * rates[1] + from[2], t * rates[2] + from[3]];
    tape.evaluate(&inputs[..tape.inputs()], &mut scratch, &mut value).unwrap();
    let (mut factorial, mut size) = (1.0, 1.0);
    for k in 0..=6 {
        let expected = value[0].derivative(k) / factorial;
        let found = series.coefficients(k + 1)[3] * (k + 1) as f64;
        if !expected.is_finite() {
            break;
        }
        // Rounding of sums of terms that may be larger than the result, as a part of the largest coefficient so far.
        size = f64::max(size, expected.abs());
        assert!(
            (found - expected).abs() <= 1e-10 * size,
            "{text} at {from:?}, order {k}: {found} instead of {expected}"
        );
        factorial *= (k + 1) as f64;
    }
}

#[test]
fn every_function_has_its_derivatives() {
    for function in Function::ALL {
        let name = function.name();
        for [x, y] in [[0.31, 0.62], [0.85, -0.4], [0.12, 0.77]] {
            let from = [x, y, 0.3, 0.2];
            match function.arguments() {
                1 => {
                    same_derivatives(&format!("{name}(x)"), from);
                    same_derivatives(&format!("{name}(0.4 + x*x'/3 + mass/9)*{name}(x)"), from);
                }
                _ => same_derivatives(&format!("{name}(x, y*x + 0.1)"), from),
            }
        }
    }
    for text in [
        "x^2*y",
        "x^3/y",
        "x^-2",
        "x^1.7",
        "(x + 2*y)^-0.3",
        "sqrt(x^2 + y^2)",
        "x^90",
        "3 - x",
        "2*x - 5*y",
        "x - x*y",
        "x + y*x'",
        "1/x",
    ] {
        same_derivatives(text, [0.83, 0.61, 0.4, 1.3]);
    }
}

proptest! {
    /// Of random formulas, off their corners.
    #[test]
    fn random_formulas_have_their_derivatives(text in expression(), from in off_corners()) {
        same_derivatives(&text, from);
    }
}

/// `x'' = -x` and `x' = x`, to the highest order: the coefficients are powers of the unit over factorials, from a unit so small that all
/// derivatives of the motion would overflow without it.
#[test]
fn known_solutions_to_the_highest_order() {
    let circle = recurrences(&["1e15*y", "-1e15*x"]);
    let series = expanded(&circle, 0.0, &[0.0, 1.0], 1e-15, MOST_ORDERS);
    let mut factorial = 1.0;
    for k in 0..=MOST_ORDERS {
        if k > 0 {
            factorial *= k as f64;
        }
        let expected = [[0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [-1.0, 0.0]][k % 4].map(|sign| sign / factorial);
        for (found, expected) in series.coefficients(k).iter().zip(expected) {
            assert!((found - expected).abs() <= 1e-14 / factorial, "order {k}: {found} instead of {expected}");
        }
    }
    assert_eq!(series.order(), MOST_ORDERS);
    // The logistic function: radius of convergence pi about 0.
    let logistic = recurrences(&["x*(1 - x)"]);
    let series = expanded(&logistic, 0.0, &[0.5], 1.0, 31);
    let at = |s: f64| (0..=31).rev().fold(0.0, |sum, k| sum * s + series.coefficients(k)[0]);
    assert!((at(0.7) - 1.0 / (1.0 + (-0.7_f64).exp())).abs() < 1e-15);
}

/// On each side of a corner the series is that of the smooth function there; and at a length that begins with zero it says that it is not
/// known.
#[test]
fn corners_have_two_sides() {
    let of = recurrences(&["1", "abs(x - 0.5) + max(x, 2*t) + sign(x)"]);
    assert_eq!(of.corners(), 3);
    let order_by_sides = |sides: &[f64]| {
        let mut series = Expansion::new(&of);
        series.expand(&of, (1.0, &[0.5, 0.0], sides), 1.0, 3);
        [1, 2].map(|k| series.coefficients(k)[1] * k as f64)
    };
    // `abs`, then `max`, then `sign`; where no side is given, by the sign of the argument.
    let on = |first: f64| order_by_sides(&[first, 0.0, 0.0]);
    assert_eq!([on(1.0), on(-1.0)], [[3.0, 3.0], [3.0, 1.0]]);
    assert_eq!(order_by_sides(&[1.0, 1.0, -1.0]), [-0.5, 2.0]);
    let series = expanded(&of, 1.0, &[0.5, 0.0], 1.0, 3);
    let arguments: Vec<Vec<f64>> = (0..3).map(|corner| series.argument(corner).collect()).collect();
    assert!(arguments.contains(&vec![0.0, 1.0, 0.0]) && arguments.contains(&vec![0.5, 1.0, 0.0]), "{arguments:?}");

    let of = recurrences(&["1", "sqrt(x^2 + (2*x)^2)"]);
    assert!(expanded(&of, 0.0, &[0.0, 0.0], 1.0, 4).leaves_zero());
    assert!(!expanded(&of, 0.0, &[1e-9, 0.0], 1.0, 4).leaves_zero());
}

/// A function of time such as `tanh` may do something of which no state tells; a sine cannot, nor a function of the state alone.
#[test]
fn sudden_functions_are_told() {
    assert!(recurrences(&["exp(-(t - 5)^2)"]).is_sudden());
    assert!(!recurrences(&["sin(20*t)/(2 + cos(t)) + exp(x)"]).is_sudden());
}
