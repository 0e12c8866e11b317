//! Which expressions are one, and which are not.

use crate::common::{built, text};
use expression::{Error, Expression, Graph, Names, parse};

#[test]
fn equal_expressions_are_one() {
    for (a, b) in [
        ("x + (y + mass)", "(mass + x) + y"),
        ("x*(y*mass)", "mass*x*y"),
        ("x - y", "-(y - x)"),
        ("x*(x - y)", "-(y - x)*x"),
        ("(x - y)^2", "(y - x)^2"),
        ("x + x + 2*x", "4*x"),
        ("x*x*x^-1", "x"),
        ("x/x + 0*y", "1"),
        ("--x", "x"),
        ("-x*-y", "x*y"),
        ("sin(-x)", "-sin(x)"),
        ("cos(y - x)", "cos(x - y)"),
        ("sqrt(x)*sqrt(x)", "x"),
        ("sqrt(x)^3", "x^1.5"),
        ("(x^3)^0.5", "x^1.5"),
        ("(2*x*y)^2", "4*x^2*y^2"),
        ("(2*x + 2*y)*3", "6*(x + y)"),
        ("0.5*(2*x + 2*y)", "x + y"),
        ("2*(x + y) - (x + y)*3 + (x + y)*2", "x + y"),
        ("1/(1/x)", "x"),
        ("x/y/mass", "x/(y*mass)"),
        ("sin(x)^2 + cos(x)^2", "1"),
        ("mass*y^2*cos(x)^2 + 3 + mass*(y*sin(x))^2", "mass*y^2 + 3"),
        ("sin(x)^3 + sin(x)*cos(x)^2", "sin(x)"),
        ("(sin(x)^2 + cos(x)^2 - 1)*y", "0"),
        ("exp(log(x))", "x"),
        ("log(exp(x))", "x"),
        ("abs(-x)", "abs(x)"),
        ("abs(x)^2", "x^2"),
        ("abs(abs(x))", "abs(x)"),
        ("min(x, y)", "min(y, x)"),
        ("max(x + y, y + x)", "x + y"),
        ("x^0", "1"),
        ("ln(x)", "log(x)"),
        ("x**2*x_dot", "x'*x^2"),
        ("2^3 + sqrt(4)", "10"),
    ] {
        let mut graph = Graph::new();
        let (a_is, b_is) = (built(&mut graph, a), built(&mut graph, b));
        assert_eq!(a_is, b_is, "{a}: {}; {b}: {}", text(&graph, a_is), text(&graph, b_is));
    }
}

/// What is not equal for all values, or only where it has none, stays apart.
#[test]
fn others_stay_apart() {
    for (a, b) in [
        ("sqrt(x^2)", "x"),
        ("(x^2)^0.5*y", "x*y"),
        ("sqrt(x*y)", "sqrt(x)*sqrt(y)"),
        ("sin(x)^2 + cos(y)^2", "1"),
        ("sin(x)^2 - cos(x)^2", "1"),
        ("2*sin(x)^2 + cos(x)^2", "1"),
        ("atan2(x, y)", "atan2(y, x)"),
        ("exp(-x)", "exp(x)"),
        ("x^0.3*x^0.7", "x"),
        ("acos(-x)", "acos(x)"),
    ] {
        let mut graph = Graph::new();
        assert_ne!(built(&mut graph, a), built(&mut graph, b), "{a} and {b}");
    }
}

/// Coefficients whose product is out of range are not multiplied.
#[test]
fn coefficients_stay_in_range() {
    for source in
        ["1e200*x*1e200", "1e-200*x*1e-200", "1e308*x + 1e308*x", "1e-320*x", "(1e200*x)^2", "1e308 + x + 1e308"]
    {
        let mut graph = Graph::new();
        let e = built(&mut graph, source);
        let syntax = crate::common::read(source);
        for x in [1e-250, 1e-30, 1.0, -1e308] {
            let tape = expression::Tape::new(&graph, &[e]).unwrap();
            let (mut scratch, mut value) = (vec![0.0; tape.scratch()], [0.0]);
            tape.evaluate(&[x; 4], &mut scratch, &mut value).unwrap();
            let direct: f64 = syntax.evaluate(&[x; 4]).unwrap();
            // Three roundings, and those below the smallest normal number.
            let close = (value[0] - direct).abs() <= 1e-15 * direct.abs() + 1e-323;
            assert!(close || !direct.is_finite(), "{source} at {x}: {direct}, {}", value[0]);
        }
    }
}

/// Multiplied out, a small coefficient beside a large one would be lost: such products stay.
#[test]
fn no_coefficient_is_swallowed() {
    let names = Names::of(["x", "y"]).unwrap();
    let expanded = |source: &str| {
        let mut graph = Graph::new();
        let variables = [0, 1].map(|k| graph.variable(k));
        let e = parse(source, &names).unwrap();
        let e = graph.build(&e, &variables).unwrap();
        let expanded = graph.expanded(e, 100);
        (expanded == e, graph.text(expanded, &names).unwrap())
    };
    for source in ["1e20*(y - x - 1) - 750*x", "1e20*(y - x - 1) - 5", "(x + 1e20)*y - 3*y"] {
        let (kept, text) = expanded(source);
        assert!(kept, "{source}: {text}");
    }
    assert_eq!(expanded("(1e20*(y - x) - x)*y").1, "-x*y - 1e20*y*(x - y)");
    // The control: what fits is multiplied out, and what cancels does.
    for (source, right) in [("1e3*(y - x - 1) + 1e3*x", "1000*y - 1000"), ("1e20*(y - x) + 1e20*x", "1e20*y")] {
        assert_eq!(expanded(source).1, right);
    }
}

#[test]
fn texts_are_readable() {
    for (source, expected) in [
        ("mass/2*(x'^2 + y^2) - 9.81*mass*x", "0.5*mass*(x'^2 + y^2) - 9.81*x*mass"),
        ("-x + 3", "-x + 3"),
        ("1/x^2/y", "1/(x^2*y)"),
        ("2/sqrt(x)", "2/sqrt(x)"),
        ("x^-0.3", "x^(-0.3)"),
        ("(x + y)^3*(-2)", "-2*(x + y)^3"),
        ("atan2(-x, y)/pi*pi", "atan2(-x, y)"),
        ("1e-7*x + 1e22", "1e-7*x + 1e22"),
    ] {
        let mut graph = Graph::new();
        let e = built(&mut graph, source);
        assert_eq!(text(&graph, e), expected);
    }
}

/// Shared parts are derived once: a chain of abbreviations that would be 2^60 terms long is differentiated in no time, and is not
/// written out.
#[test]
fn abbreviations_are_shared() {
    let mut graph = Graph::new();
    let names = Names::of(["x"]).unwrap();
    let syntax = parse("sin(x)*cos(x) + x^2", &names).unwrap();
    let mut e = graph.variable(0);
    for _ in 0..60 {
        e = graph.build(&syntax, &[e]).unwrap();
    }
    let first: Expression = graph.derivative(e, 0);
    let second = graph.derivative(first, 0);
    assert_ne!(second, first);
    assert!(graph.len() < 20_000, "{}", graph.len());
    assert!(expression::Tape::new(&graph, &[e, first, second]).unwrap().cost().total() < 20_000);
    assert!(matches!(graph.text(e, &names), Err(Error::TextTooLong { .. })));
}
