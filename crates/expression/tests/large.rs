//! A system of ten coordinates, from text to all that a method asks of it. How long that takes is measured by
//!
//! ```text
//! NOSLIP_MEASURE=1 cargo test --release -p noslip-expression -- --ignored --nocapture how_long_it_takes
//! ```

use expression::{Expression, Graph, Names, Tape, parse};
use lagrangian::{HyperDual, Scalar};
use std::time::Instant;

const N: usize = 10;

/// A chain of ten pendulums, its velocities by abbreviations, as a person writes it.
fn chain() -> (Graph, Expression) {
    let mut names = Names::new();
    let mut graph = Graph::new();
    let mut meanings = Vec::new();
    for k in 0..N {
        names.add(&format!("a{k}")).unwrap();
        meanings.push(graph.variable(k as u32));
    }
    for k in 0..N {
        names.add(&format!("a{k}'")).unwrap();
        meanings.push(graph.variable((N + k) as u32));
    }
    for (name, value) in [("m", 1.25), ("l", 0.7), ("g", 9.81)] {
        names.add(name).unwrap();
        meanings.push(graph.constant(value));
    }
    let mut energy = Vec::new();
    for k in 0..N {
        let before = |name: &str| if k == 0 { "0".to_owned() } else { format!("{name}{}", k - 1) };
        for (name, text) in [
            (format!("vx{k}"), format!("{} + l*cos(a{k})*a{k}'", before("vx"))),
            (format!("vy{k}"), format!("{} + l*sin(a{k})*a{k}'", before("vy"))),
            (format!("y{k}"), format!("{} - l*cos(a{k})", before("y"))),
        ] {
            let meaning = graph.build(&parse(&text, &names).unwrap(), &meanings).unwrap();
            names.add(&name).unwrap();
            meanings.push(meaning);
        }
        energy.push(format!("m/2*(vx{k}^2 + vy{k}^2) - m*g*y{k}"));
    }
    let lagrangian = parse(&energy.join(" + "), &names).unwrap();
    let lagrangian = graph.build(&lagrangian, &meanings).unwrap();
    (graph, lagrangian)
}

/// Value, gradient, and the blocks of second derivatives in velocities, and in velocities and coordinates.
fn derived() -> Tape {
    let (q, v): (Vec<u32>, Vec<u32>) = ((0..N as u32).collect(), (N as u32..2 * N as u32).collect());
    let (mut graph, lagrangian) = chain();
    let mut outputs = vec![lagrangian];
    outputs.extend(graph.gradient(lagrangian, &[&q[..], &v].concat()));
    outputs.extend(graph.hessian(lagrangian, &v, &v).concat());
    outputs.extend(graph.hessian(lagrangian, &v, &q).concat());
    Tape::new(&graph, &outputs).unwrap()
}

fn on<S: Scalar>(tape: &Tape, x: &[S]) -> Vec<S> {
    let (mut scratch, mut outputs) = (vec![S::zero(); tape.scratch()], vec![S::zero(); tape.outputs()]);
    tape.evaluate(x, &mut scratch, &mut outputs).unwrap();
    outputs
}

fn place() -> [f64; 2 * N] {
    std::array::from_fn(|k| (1.0 + k as f64).sin() * 1.5)
}

#[test]
fn derivatives_of_a_chain_of_ten() {
    let (graph, lagrangian) = chain();
    let alone = Tape::new(&graph, &[lagrangian]).unwrap();
    let tape = derived();
    let values = on(&tape, &place());
    let x = place();
    for i in 0..N {
        let seeds: Vec<HyperDual<f64, 1, { 2 * N }>> = (0..2 * N)
            .map(|k| HyperDual::linear(x[k], [f64::from(k == N + i)], std::array::from_fn(|j| f64::from(j == k))))
            .collect();
        let dual = on(&alone, &seeds)[0];
        // Sums of some hundred terms of order ten.
        let close = |a: f64, b: f64| (a - b).abs() < 1e-11;
        assert!(close(values[0], dual.re) && close(values[1 + N + i], dual.e1[0]));
        for j in 0..N {
            assert!(close(values[1 + j], dual.e2[j]), "L_q {j}");
            assert!(close(values[1 + 2 * N + N * i + j], dual.e12[0][N + j]), "L_vv {i} {j}");
            assert!(close(values[1 + 2 * N + N * N + N * i + j], dual.e12[0][j]), "L_vq {i} {j}");
        }
    }
    // All 221 numbers for what 25 values cost.
    assert!(tape.cost().total() < 25 * alone.cost().total(), "{:?}, {:?}", tape.cost(), alone.cost());
}

#[test]
#[ignore = "measures, if NOSLIP_MEASURE=1"]
fn how_long_it_takes() {
    if std::env::var_os("NOSLIP_MEASURE").is_none_or(|value| value != "1") {
        return;
    }
    let best = |f: &mut dyn FnMut()| (0..20).map(|_| (Instant::now(), f()).0.elapsed()).min().unwrap();
    let (graph, lagrangian) = chain();
    let alone = Tape::new(&graph, &[lagrangian]).unwrap();
    let tape = derived();
    println!("text to tape with derivatives: {:?}", best(&mut || drop(derived())));
    println!("text to graph: {:?}", best(&mut || drop(chain())));
    println!("{:?} scratch {}", alone.cost(), alone.scratch());
    println!("{:?} total {} scratch {}", tape.cost(), tape.cost().total(), tape.scratch());
    for tape in [alone, tape] {
        let (mut scratch, mut outputs) = (vec![0.0; tape.scratch()], vec![0.0; tape.outputs()]);
        let time = best(&mut || (0..1000).for_each(|_| tape.evaluate(&place(), &mut scratch, &mut outputs).unwrap()));
        println!("an evaluation: {:?}", time / 1000);
    }
}
