//! Where formulas of time are not smooth, and derivatives of high order.

use expression::{Corners, Expression, Graph, Names, Series, Tape, Turned, parse};
use lagrangian::{Dual, HyperDual};
use scalar::Scalar;
use std::f64::consts::PI;

/// A formula of `t` in a graph.
fn of_time(text: &str) -> (Graph, Expression) {
    let (mut graph, names) = (Graph::new(), Names::of(["t"]).unwrap());
    let t = graph.variable(0);
    let e = graph.build(&parse(text, &names).unwrap(), &[t]).unwrap();
    (graph, e)
}

/// The values of a tape on these inputs.
fn value<S: Scalar>(graph: &Graph, e: Expression, inputs: &[S]) -> S {
    let tape = Tape::new(graph, &[e]).unwrap();
    let mut value = S::zero();
    let mut scratch = vec![S::zero(); tape.scratch()];
    tape.evaluate_with(|k| inputs[k], &mut scratch, |_, x| value = x).unwrap();
    value
}

#[test]
fn corners_are_found_and_no_others() {
    let third = |k: i32| f64::from(k) * PI / 3.0;
    let cases: [(&str, Vec<f64>); 18] = [
        ("floor(t/2.5)", vec![2.5, 5.0, 7.5]),
        ("mod(t - 1, 3)*step(t - 6)", vec![1.0, 4.0, 6.0, 7.0]),
        ("if(t < 2.5, sqrt(2.5 - t), log(t - 1))", vec![2.5]),
        ("if(sin(t) >= 0, 1, if(t > 4, 2, 3))", vec![PI, 4.0, 2.0 * PI, 3.0 * PI]),
        ("step(t - 2)*t + hypot(t, 1)", vec![2.0]),
        ("max(t - 7, 3 - t, 0)", vec![3.0, 7.0]),
        ("sign(t - 1.05)", vec![1.05]),
        ("10*(sign(t - 1) - sign(t - 1.05))", vec![1.0, 1.05]),
        ("max(0, sin(3*t))", (1..10).map(third).collect()),
        ("abs(sin(t))", vec![PI, 2.0 * PI, 3.0 * PI]),
        // It touches zero, and does not turn.
        ("abs(1 - cos(t)) + max(t^2, 0) + sign(1 + exp(-t))", vec![]),
        ("min(t, 2)^2 + abs(t - 2)", vec![2.0]),
        // One within another, and one that is zero for a while.
        ("abs(max(0, t - 3))", vec![3.0]),
        ("abs(abs(t - 4) - 1)", vec![3.0, 4.0, 5.0]),
        ("sign(tanh(1e4*(t - 2.5)))", vec![2.5]),
        ("sign(log(t/3)*sqrt(t + 1))", vec![3.0]),
        ("max(atan2(t - 5, 1), 0)", vec![5.0]),
        ("sin(abs(7))*t", vec![]),
    ];
    for (text, expected) in cases {
        let (mut graph, e) = of_time(text);
        let corners = Corners::of(&mut graph, &[e], 0, 1).unwrap();
        let found = corners.map_or(Vec::new(), |(corners, _)| corners.between(0.0, 10.0).unwrap());
        assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
        for (found, expected) in found.iter().zip(&expected) {
            // A sign is told to the last bits of the argument.
            assert!((found - expected).abs() <= 4.0 * f64::EPSILON * expected, "{text}: {found} {expected}");
        }
    }
    let (mut graph, e) = of_time("sign(sin(1e9*t))");
    assert_eq!(Corners::of(&mut graph, &[e], 0, 1).unwrap().unwrap().0.between(0.0, 10.0), None);
}

#[test]
fn a_piece_is_the_formula_between_its_corners() {
    for text in ["abs(sin(t))*max(t, 2*cos(t)) - sign(t - 2)", "abs(abs(t - 4) - 1)", "min(max(t, 2), 5 - t)^3"] {
        let (mut graph, e) = of_time(text);
        let (corners, pieces) = Corners::of(&mut graph, &[e], 0, 1).unwrap().unwrap();
        let slopes = [e, pieces[0]].map(|e| graph.derivative(e, 0));
        for k in 0..40 {
            let t = 0.1 + 0.2501 * f64::from(k);
            let inputs = [vec![t], corners.sides(t)].concat();
            for [whole, piece] in [[e, pieces[0]], slopes] {
                let [whole, piece] = [whole, piece].map(|e| value(&graph, e, &inputs));
                assert!((whole - piece).abs() <= 1e-14 * whole.abs().max(1.0), "{text} at {t}: {whole} {piece}");
            }
        }
    }
}

/// Derivatives up to the sixth, as series and as formulas.
#[test]
fn a_series_has_the_derivatives_of_the_formula() {
    let texts = [
        "tanh(10*sin(3*t))*exp(-t/10)/(1+t^2)",
        "atan2(sin(t), 2 + cos(t))*sinh(t) - cosh(t/2)",
        "sqrt(1 + t^2)*log(2 + t) + t^2.5 + tan(t/3)",
        "asin(t/3)*acos(t/4)*atan(t) + abs(t - 4)*inverse(1 + t)",
        "max(t, 0.1)^-3 + min(t, 9)*exp(sin(sin(t)))",
    ];
    for text in texts {
        let (mut graph, e) = of_time(text);
        for t in [0.3, 1.1, 2.2] {
            let series = value(&graph, e, &[Series::variable(t)]);
            let mut derivative = e;
            for order in 0..=6 {
                let (found, expected) = (series.derivative(order), value(&graph, derivative, &[t]));
                // Formulas of the sixth derivative lose digits where their terms cancel.
                assert!(
                    (found - expected).abs() <= 1e-9 * expected.abs().max(1.0),
                    "{text} {order}: {found} {expected}"
                );
                derivative = graph.derivative(derivative, 0);
            }
        }
    }
}

/// Where `max(0, x)` and the like vanish, so do all derivatives of their powers, in formulas and on numbers that carry derivatives.
#[test]
fn powers_of_what_is_flat_are_flat() {
    for text in [
        "max(0, t)^1.5",
        "sqrt(max(0, t))",
        "max(0, t)^1.3",
        "(-min(0, -t))^0.7",
        "sqrt(max(0, t)*(2 + t))^3",
        "abs(max(t, 0))^2.2",
    ] {
        let (mut graph, e) = of_time(text);
        let slope = graph.derivative(e, 0);
        let second = graph.derivative(slope, 0);
        for t in [-1.0, 0.0] {
            assert_eq!([e, slope, second].map(|e| value(&graph, e, &[t])), [0.0; 3], "{text} at {t}");
            let twice = value(&graph, e, &[HyperDual::linear(t, [1.0], [1.0])]);
            assert!(twice.is_zero(), "{text} at {t}: {twice:?}");
        }
        let there = value(&graph, e, &[Dual::<f64, 1>::variable(0.7, 0)]);
        let formula = value(&graph, slope, &[0.7]);
        assert!(formula > 0.0 && (there.eps[0] - formula).abs() < 1e-14 * formula, "{text}: {there:?} {formula}");
    }
    // What is negative has no root, and what is not flat an infinite slope.
    let (mut graph, e) = of_time("sqrt(max(t, -2)) + sqrt(t + 1)");
    assert!(value(&graph, e, &[-0.5]).is_nan());
    let slope = graph.derivative(e, 0);
    assert!(!value(&graph, slope, &[-1.0]).is_finite());
}

#[test]
fn the_form_of_a_formula_tells_its_period() {
    let names = Names::of(["a", "b", "x"]).unwrap();
    let mut graph = Graph::new();
    let variables = [0, 1, 2].map(|k| graph.variable(k));
    let cases = [
        ("x^2 + exp(cos(a))/(2 + sin(3*a - b))", "same"),
        ("tan(a/2)*x + atan2(sin(a), cos(a))", "same"),
        ("cos(a + x)^3*(a - b - a)", "same"),
        ("a", "changed"),
        ("x*(1 + 1e-13*a)", "changed"),
        ("sin(a/2)", "changed"),
        ("exp(-a^2)", "changed"),
        ("cos(x)*abs(a - 3)", "changed"),
        ("max(a, x)", "changed"),
        ("sin(a/2)^2", "open"),
        ("x + sin(a/2)*cos(a/2)", "open"),
        ("sin(a^2)", "open"),
        ("cos(a/3)^2 - sin(a/3)^2", "open"),
    ];
    for (text, expected) in cases {
        let e = graph.build(&parse(text, &names).unwrap(), &variables).unwrap();
        let found = match graph.turned(e, 0) {
            Turned::Same => "same",
            Turned::Changed => "changed",
            Turned::Open(_) => "open",
        };
        assert_eq!(found, expected, "{text}");
    }
}
