//! What is simplified, derived and put on a tape against the text evaluated as it was written.

use crate::common::{NAMES, agree, built, expression, names, off_corners, read, text, values, variables};
use expression::{Error, Graph, Tape, parse};
use lagrangian::{Dual, Rounded, Scalar};
use num_dual::HyperDual64;
use proptest::prelude::*;

/// What a tape computes.
fn evaluated<S: Scalar>(tape: &Tape, inputs: &[S]) -> Vec<S> {
    let nothing = S::constant(f64::NAN);
    let (mut scratch, mut outputs) = (vec![nothing; tape.scratch()], vec![nothing; tape.outputs()]);
    tape.evaluate(inputs, &mut scratch, &mut outputs).unwrap();
    outputs
}

/// The graph of a text and its expression; `None` if the text divides by zero, whatever the variables are.
fn graph(source: &str) -> Option<(Graph, expression::Expression)> {
    let mut graph = Graph::new();
    let variables = variables(&mut graph);
    match graph.build(&read(source), &variables) {
        Ok(e) => Some((graph, e)),
        Err(Error::NotFinite { .. }) => None,
        Err(error) => panic!("{source}: {error}"),
    }
}

const ALL: [u32; 4] = [0, 1, 2, 3];

/// No zeros where a text may divide by them: it may come back from infinity.
fn off_zero(source: &str, x: [f64; 4]) -> [f64; 4] {
    x.map(|x| if x == 0.0 && (source.contains('/') || source.contains("-")) { 1.25 } else { x })
}

fn tape_has_the_value(source: &str, x: [f64; 4]) {
    let x = off_zero(source, x);
    let Some((graph, e)) = graph(source) else { return };
    let tape = Tape::new(&graph, &[e]).unwrap();
    let once = x.map(Rounded::once);
    let (direct, computed) = (read(source).evaluate(&once).unwrap(), evaluated(&tape, &once)[0]);
    assert!(agree(direct, computed), "{source} at {x:?}: {direct:?}, {computed:?} by {}", text(&graph, e));
}

/// First and second derivatives of the graph, beside two kinds of dual numbers on the text: ours with bounds, and num-dual.
fn derivatives_are_those_of_dual_numbers(source: &str, x: [f64; 4]) {
    let Some((mut graph, e)) = graph(source) else { return };
    let gradient = graph.gradient(e, &ALL);
    let hessian = graph.hessian(e, &ALL, &ALL);
    let outputs: Vec<_> = gradient.iter().chain(hessian.iter().flatten()).copied().collect();
    let tape = Tape::new(&graph, &outputs).unwrap();
    let computed = evaluated(&tape, &x.map(Rounded::once));
    let syntax = read(source);
    let seeds: [Dual<Dual<Rounded, 4>, 4>; 4] =
        std::array::from_fn(|i| Dual::variable(Dual::variable(Rounded::once(x[i]), i), i));
    let dual = syntax.evaluate(&seeds).unwrap();
    for i in 0..4 {
        assert!(
            agree(dual.eps[i].re, computed[i]),
            "{source} in {} at {x:?}: {:?}, {:?} by {}",
            NAMES[i],
            dual.eps[i].re,
            computed[i],
            text(&graph, outputs[i])
        );
        for j in 0..4 {
            let (k, second) = (4 + 4 * i + j, dual.eps[i].eps[j]);
            assert!(
                agree(second, computed[k]),
                "{source} in {}, {} at {x:?}: {second:?}, {:?} by {}",
                NAMES[i],
                NAMES[j],
                computed[k],
                text(&graph, outputs[k])
            );
            let seed = |k: usize| HyperDual64::new(x[k], f64::from(k == i), f64::from(k == j), 0.0);
            let theirs = syntax.evaluate(&[0, 1, 2, 3].map(seed)).unwrap();
            // At corners they have no derivatives, and their 1 - tanh^2 has no digits where it is small. Elsewhere other formulas
            // than ours, of some roundings more.
            let corner = ["abs", "min", "max", "tanh"].iter().any(|word| source.contains(word));
            let bounded = Rounded { value: theirs.eps1eps2, size: 100.0 * second.size };
            assert!(corner || agree(bounded, computed[k]), "{source} at {x:?}: {theirs}, {:?}", computed[k]);
        }
    }
}

/// Printed and read again an expression is the same one, and Rust text can be printed of it.
fn the_text_comes_back(source: &str) {
    let Some((mut graph, e)) = graph(source) else { return };
    let first = graph.derivative(e, 0);
    for e in [e, first] {
        let printed = text(&graph, e);
        let again = match parse(&printed, &names()).and_then(|syntax| {
            let variables = variables(&mut graph);
            graph.build(&syntax, &variables)
        }) {
            Ok(again) => again,
            // Of a derivative that exists nowhere.
            Err(Error::NotFinite { .. }) if printed.contains("/0") => return,
            Err(error) => panic!("{source}, {printed}: {error}"),
        };
        assert_eq!(again, e, "{source}: {printed} and {}", text(&graph, again));
        assert!(graph.rust(&[e], &["a", "b", "c", "d"]).unwrap().ends_with("]\n"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn a_tape_has_the_value_of_the_text(source in expression(), x in values()) {
        tape_has_the_value(&source, x);
    }

    #[test]
    fn derivatives_of_any_text(source in expression(), x in off_corners()) {
        derivatives_are_those_of_dual_numbers(&source, x);
    }

    #[test]
    fn any_text_comes_back(source in expression()) {
        the_text_comes_back(&source);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]
    #[test]
    #[ignore = "slow"]
    fn many_texts(source in expression(), x in values(), y in off_corners()) {
        tape_has_the_value(&source, x);
        derivatives_are_those_of_dual_numbers(&source, y);
        the_text_comes_back(&source);
    }
}

/// Values at points where they are known.
#[test]
fn known_values() {
    let x = [2.0, 3.0, -0.5, 4.0];
    for (source, expected) in [
        ("1 + 2*3^2", 19.0),
        ("-x^2", -4.0),
        ("2^-x^2", 0.0625),
        ("2**3**2", 512.0),
        ("x - y - mass", -5.0),
        ("x/y*3/mass", 0.5),
        ("-x*-y", 6.0),
        ("+x - -y", 5.0),
        ("x_dot*x'", 0.25),
        ("1.5e1 + 2E-1 + .5 + 1.", 16.7),
        ("min(x, y) + max(x, y)", 5.0),
        ("atan2(1, -1)*4/pi", 3.0),
        ("abs(x')*sign(x')", -0.5),
        ("sqrt(mass)^3", 8.0),
        ("log(exp(x))", 2.0),
        ("mass^0.5^1", 2.0),
        ("(x*y)^-1*6", 1.0),
        ("sqrt(mass)*sqrt(mass)^1.5/2^1.5 + sqrt(mass)^1.5*y/2^1.5", 5.0),
        ("sin(pi/2) + cos(0) + tan(0) + asin(0) + acos(1) + atan(0)", 2.0),
        ("sinh(0) + cosh(0) + tanh(0)", 1.0),
    ] {
        let mut graph = Graph::new();
        let e = built(&mut graph, source);
        let tape = Tape::new(&graph, &[e]).unwrap();
        // A sum of a few terms of order ten, each rounded once or twice.
        assert!((evaluated(&tape, &x)[0] - expected).abs() < 1e-14, "{source}: {}", evaluated(&tape, &x)[0]);
        assert!((read(source).evaluate(&x).unwrap() - expected).abs() < 1e-14, "{source} as it is written");
    }
}

/// At corners derivatives are the means of both sides, as with dual numbers.
#[test]
fn corners() {
    for (source, expected) in [
        ("sqrt(x^2 + y^2)*x", 0.0),
        ("sqrt(2*x^2 + y^4*x^2)", 0.0),
        ("(x^2 + y^2)^1.5", 0.0),
        ("atan2(x, y)", 0.0),
        ("abs(x)", 0.0),
        ("max(x, 3*x)", 2.0),
        ("min(x, 3*x)", 2.0),
        ("x*abs(x)", 0.0),
        ("sign(x)", 0.0),
    ] {
        let mut graph = Graph::new();
        let e = built(&mut graph, source);
        let slope = graph.derivative(e, 0);
        let tape = Tape::new(&graph, &[slope]).unwrap();
        assert_eq!(evaluated(&tape, &[0.0; 4]), [expected], "{source}");
        let dual = Tape::new(&graph, &[e]).unwrap();
        let dual = evaluated(&dual, &[0.0, 0.0, 1.0, 1.0].map(|x| Dual::<f64, 1>::variable(x, 0)));
        let slope = if source.starts_with("max(x, 3") || source.starts_with("min(x, 3") { 2.0 } else { 0.0 };
        assert_eq!(dual[0].eps, [slope], "{source}");
    }
}

/// Substituted, an expression is the one that is written so.
#[test]
fn substitution() {
    let mut graph = Graph::new();
    let e = built(&mut graph, "sin(x)^2*y + mass^x' + sqrt(x*y)");
    let [x, mass] = [built(&mut graph, "x' + 1"), graph.constant(2.0)];
    let replaced = graph.substitute(e, &[(0, x), (3, mass)]);
    assert_eq!(replaced, built(&mut graph, "sin(x' + 1)^2*y + 2^x' + sqrt((x' + 1)*y)"));
    assert_eq!(graph.variables(replaced), [1, 2]);
    assert_eq!(graph.variables(e), [0, 1, 2, 3]);
    for (text, column) in [("sin(x) + tanh(y) - sign(x')", 20), ("1 + step(x)", 5), ("x*if(x < y, 1, 2)", 3)] {
        assert_eq!(read(text).first_jump(), Some(column), "{text}");
    }
    assert_eq!(read("min(abs(x), max(y, hypot(x, y), 2))").first_jump(), None);
    assert_eq!(read("y + x' + y").names(), [1, 2]);
}

/// A choice has the value and the derivatives of what is chosen, also where the other has none.
#[test]
fn choices() {
    for (source, at, value, slope) in [
        ("if(x < 0, 2*x, x^2)", -3.0, -6.0, 2.0),
        ("if(x < 0, 2*x, x^2)", 3.0, 9.0, 6.0),
        ("if(x < 0, log(-x), sqrt(x))", 4.0, 2.0, 0.25),
        ("if(x < 0, log(-x), sqrt(x))", -1.0, 0.0, -1.0),
        ("if(x > 0, 1/x, 5)", 0.0, 5.0, 0.0),
        ("if(x >= 0, 1 + 3*x, 5)", 0.0, 1.0, 3.0),
        ("if(0 <= x, 1 + 3*x, 5)", 0.0, 1.0, 3.0),
        ("if(x <= 0, 1 + 3*x, 5)", 0.0, 1.0, 3.0),
        ("step(x)*x", 2.0, 2.0, 1.0),
        ("floor(x)", 2.0, 2.0, 0.0),
        ("x*floor(x)", -1.5, 3.0, -2.0),
        ("mod(x, 3)", 7.5, 1.5, 1.0),
        ("mod(x, 3)", -1.0, 2.0, 1.0),
        ("mod(x, 3)", 6.0, 0.0, 1.0),
        ("mod(-x, 3)", 6.5, 2.5, -1.0),
        ("step(x) + 0*x", 0.0, 0.5, 0.0),
        ("hypot(x, 4)", 3.0, 5.0, 0.6),
        ("hypot(x, 2*x, 2*x)", 0.0, 0.0, 0.0),
        ("max(x, 2*x, 3*x)", 1.0, 3.0, 3.0),
    ] {
        let mut graph = Graph::new();
        let e = built(&mut graph, source);
        let slopes = graph.derivative(e, 0);
        let tape = Tape::new(&graph, &[e, slopes]).unwrap();
        assert_eq!(evaluated(&tape, &[at, 0.0, 0.0, 0.0]), [value, slope], "{source} at {at}");
        assert_eq!(read(source).evaluate(&[at, 0.0, 0.0, 0.0]).unwrap(), value, "{source} at {at}");
        let again = parse(&text(&graph, e), &names()).unwrap().evaluate(&[at, 0.0, 0.0, 0.0]).unwrap();
        assert_eq!(again, value, "{source} at {at}");
    }
}
