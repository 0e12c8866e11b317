//! Tapes on every kind of number, what they cost, and that they need nothing but their scratch.

use crate::common::{built, read};
use expression::{Cost, Error, Graph, Tape};
use lagrangian::simd::{Kernel, Pack, Simd, Wide, dispatch};
use lagrangian::{Dual, HyperDual, Lanes, Scalar, vectorized};

const MIXTURE: &str =
    "mass/2*(x'^2 + y^2)*sin(x + y) - cos(x + y)*exp(-x^2)/sqrt(1 + y^2) + atan2(x, y)*max(x, y) + x^7 - tanh(y)^-3";

/// The value and the first derivatives of the mixture.
fn mixture() -> Tape {
    let mut graph = Graph::new();
    let e = built(&mut graph, MIXTURE);
    let mut outputs = vec![e];
    outputs.extend(graph.gradient(e, &[0, 1, 2, 3]));
    Tape::new(&graph, &outputs).unwrap()
}

fn on<S: Scalar>(tape: &Tape, x: [S; 4]) -> Vec<S> {
    let (mut scratch, mut outputs) = (vec![S::zero(); tape.scratch()], vec![S::zero(); tape.outputs()]);
    tape.evaluate(&x, &mut scratch, &mut outputs).unwrap();
    outputs
}

const X: [f64; 4] = [0.7, -1.2, 0.4, 2.5];

/// A sum of ten terms below ten, each of some ten roundings.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-13
}

#[test]
fn a_tape_on_dual_numbers_derives() {
    let tape = mixture();
    let values = on(&tape, X);
    let dual = on(&tape, Dual::variables(&X));
    let second = on(
        &tape,
        [0, 1, 2, 3].map(|i| {
            let unit: [f64; 4] = std::array::from_fn(|k| f64::from(k == i));
            HyperDual::<f64, 4, 4>::linear(X[i], unit, unit)
        }),
    );
    for i in 0..4 {
        assert!(close(dual[0].eps[i], values[1 + i]), "{i}: {} {}", dual[0].eps[i], values[1 + i]);
        for j in 0..4 {
            assert!(close(second[0].e12[i][j], dual[1 + i].eps[j]), "{i} {j}");
        }
    }
}

/// The numbers in the registers of the machine, eight different points.
struct InPacks<'a>(&'a Tape, &'a [[f64; 8]; 4]);

impl Kernel for InPacks<'_> {
    type Output = Vec<[f64; 8]>;
    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> Vec<[f64; 8]> {
        let inputs = self.1.map(|row| Wide::Each(Pack::<S, R>::load(simd, &row)));
        let mut scratch = vec![Wide::Zero; self.0.scratch()];
        let mut outputs = vec![Wide::Zero; self.0.outputs()];
        self.0.evaluate(&inputs, &mut scratch, &mut outputs).unwrap();
        outputs.into_iter().map(|wide| wide.pack(simd).row()).collect()
    }
}

#[test]
fn eight_points_side_by_side_are_those_one_by_one() {
    let tape = mixture();
    let points: [[f64; 8]; 4] = std::array::from_fn(|k| std::array::from_fn(|lane| X[k] + 0.01 * lane as f64));
    let lanes = vectorized(|| on(&tape, points.map(Lanes)));
    let packs = dispatch(InPacks(&tape, &points));
    for lane in 0..8 {
        let one = on(&tape, points.map(|row| row[lane]));
        for (k, &value) in one.iter().enumerate() {
            assert!(close(lanes[k].0[lane], value), "{k} in lane {lane}");
            assert!(packs.as_ref().is_none_or(|packs| close(packs[k][lane], value)), "{k} in place {lane}");
        }
    }
}

#[test]
fn an_evaluation_allocates_nothing() {
    let tape = mixture();
    let (mut scratch, mut outputs) = (vec![f64::NAN; tape.scratch()], [0.0; 5]);
    let seen = allocation_counter::measure(|| tape.evaluate(&X, &mut scratch, &mut outputs).unwrap());
    assert_eq!(seen.count_total, 0);
    // The counter counts.
    assert!(allocation_counter::measure(|| drop(mixture())).count_total > 0);
    assert!(close(outputs[0], read(MIXTURE).evaluate(&X).unwrap()));
}

#[test]
fn too_few_numbers_are_refused() {
    let tape = mixture();
    let (mut scratch, mut outputs) = (vec![0.0; tape.scratch()], [0.0; 5]);
    let few = |what, expected, found| Err(Error::TooFew { what, expected, found });
    assert_eq!((tape.inputs(), tape.outputs()), (4, 5));
    assert_eq!(tape.evaluate(&X[..3], &mut scratch, &mut outputs), few("inputs", 4, 3));
    assert_eq!(
        tape.evaluate(&X, &mut scratch[1..], &mut outputs),
        few("numbers of scratch", tape.scratch(), tape.scratch() - 1)
    );
    assert_eq!(tape.evaluate(&X, &mut scratch, &mut outputs[..4]), few("outputs", 5, 4));
    assert_eq!(tape.evaluate(&X, &mut scratch, &mut outputs), Ok(()));
}

fn cost(sources: &[&str]) -> Cost {
    let mut graph = Graph::new();
    let outputs: Vec<_> = sources.iter().map(|source| built(&mut graph, source)).collect();
    Tape::new(&graph, &outputs).unwrap().cost()
}

#[test]
fn what_is_common_is_computed_once() {
    let none = Cost::default();
    for (sources, expected) in [
        (&["x"][..], none),
        (&["x*y + x*mass"], Cost { sums: 1, products: 1, ..none }),
        (&["x*y*mass", "x*y*x'"], Cost { products: 3, ..none }),
        (&["x + y + mass", "x - x' + y"], Cost { sums: 3, ..none }),
        (&["x + y + mass", "x' - x - y"], Cost { sums: 3, ..none }),
        (&["2*x + 2*y"], Cost { sums: 1, products: 1, ..none }),
        (&["sin(x)", "cos(x)"], Cost { angles: 1, ..none }),
        (&["x^4"], Cost { products: 2, ..none }),
        (&["x/mass", "y/mass"], Cost { products: 2, quotients: 1, ..none }),
        (&["x/sqrt(y)", "sqrt(y)"], Cost { roots: 1, quotients: 1, ..none }),
        (&["mass/2*x'^2 - mass*9.81*y"], Cost { sums: 1, products: 5, ..none }),
        (&["exp(x) + exp(x)*y"], Cost { sums: 1, products: 1, exponentials: 1, ..none }),
    ] {
        assert_eq!(cost(sources), expected, "{sources:?}");
    }
}

/// A long sum needs a few registers only.
#[test]
fn registers_are_used_again() {
    let source: Vec<String> = (1..200).map(|k| format!("sin({k}*x)*y")).collect();
    let mut graph = Graph::new();
    let e = built(&mut graph, &source.join(" + "));
    let tape = Tape::new(&graph, &[e]).unwrap();
    assert!(tape.scratch() < 210, "{}", tape.scratch());
    let mut chain = graph.variable(0);
    for _ in 0..300 {
        let sin = graph.call(expression::Function::Sin, &[chain]);
        let one = graph.constant(1.0);
        chain = graph.sum(&[sin, one]);
    }
    assert_eq!(Tape::new(&graph, &[chain]).unwrap().scratch(), 1);
}

/// The same text makes the same tape.
#[test]
fn tapes_are_made_the_same_again() {
    assert_eq!(mixture(), mixture());
}
