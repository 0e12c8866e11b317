//! The Rust text of an expression is compiled here, and computes what its tape computes.

use crate::common::built;
use expression::{Error, Expression, Graph, Tape};
use lagrangian::{Dual, Scalar};

const SOURCE: &str =
    "mass/2*(x'^2 + y^2)*sin(x + y) - cos(x + y)*exp(-x^2)/sqrt(1 + y^2) - atan2(x, y)*max(x, 2) + x^19
    - (-tanh(y) - 1)*(1 - x) + abs(x - 3)^0.3 + log(2 + tan(x*y)^2)*sign(y) - 3*x'/(x - 1.5*y)^2 + min(-x, y)/mass
    + if(x < mass - 0.5, log(mass - x), x*y)*step(y) + hypot(x, y, 2)*if(mass >= 1, 3, sqrt(mass))";

fn function() -> (Graph, Vec<Expression>) {
    let mut graph = Graph::new();
    let e = built(&mut graph, SOURCE);
    let mut outputs = vec![e];
    outputs.extend(graph.gradient(e, &[0, 1, 2, 3]));
    (graph, outputs)
}

/// What is printed of the expressions, as a function: `printed/function.in` holds the text between braces.
#[allow(clippy::let_and_return)]
fn printed<S: Scalar>(q: &[S; 2], v: &[S; 1], m: S) -> [S; 5] {
    include!("printed/function.in")
}

#[test]
fn the_text_is_what_is_compiled_here() {
    let (graph, outputs) = function();
    let text = graph.rust(&outputs, &["q[0]", "q[1]", "v[0]", "m"]).unwrap();
    assert_eq!(format!("{{\n{text}}}\n"), include_str!("printed/function.in"), "the text that is to stand there");
}

#[test]
fn the_text_computes_what_the_tape_does() {
    let (graph, outputs) = function();
    let tape = Tape::new(&graph, &outputs).unwrap();
    for x in [[0.7, -1.2, 0.4, 2.5], [2.7, 0.3, -1.0, 0.5], [-0.1, 4.0, 2.0, 1.0]] {
        let (mut scratch, mut values) = (vec![0.0; tape.scratch()], [0.0; 5]);
        tape.evaluate(&x, &mut scratch, &mut values).unwrap();
        // The same operations in the same order.
        assert_eq!(printed(&[x[0], x[1]], &[x[2]], x[3]).map(f64::to_bits), values.map(f64::to_bits));
        let [a, b, c, d] = Dual::variables(&x);
        let slopes = printed(&[a, b], &[c], d)[0].eps;
        for k in 0..4 {
            assert!((slopes[k] - values[1 + k]).abs() <= 1e-12 * (1.0 + values[1 + k].abs()), "{k}");
        }
    }
}

#[test]
fn variables_without_a_name_are_refused() {
    let (graph, outputs) = function();
    let few = Error::TooFew { what: "variables", expected: 4, found: 2 };
    assert_eq!(graph.rust(&outputs, &["x", "y"]), Err(few));
}
