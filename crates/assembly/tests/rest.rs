//! Trains that come to rest, and trains at rest.

use crate::tools::train;
use assembly::parts::{Trailer, Train};
use assembly::{AssemblyMethod, AssemblyState, Solver, SparseComposition, SparseDla};
use lagrangian::With;
use sleigh::effects::{Bowl, Drag};
use sleigh::{Sleigh, SleighState};

/// A sleigh with drag and two trailers, in a well off the origin under every blade.
fn damped() -> Train {
    let well = || Bowl::new([3.0, 7.0], [0.3, 0.7]).unwrap();
    let lead = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: (well(), Drag::new(2.0, 1.5).unwrap()) };
    let trailer = Trailer::new(0.3, 0.05, 0.0, 0.0, 0.5).unwrap();
    let body = |trailer: &Trailer| With { body: trailer.sleigh, effects: (well(), Drag::new(0.5, 0.0).unwrap()) };
    Train::new(lead, vec![trailer; 2], body).unwrap()
}

fn methods(train: &Train) -> Vec<(&'static str, Box<dyn AssemblyMethod>)> {
    let (assembly, solver) = (&train.assembly, Solver::Best);
    vec![
        ("dla", Box::new(SparseDla::new(assembly, solver).unwrap())),
        ("dla4", Box::new(SparseComposition::new(assembly, solver, 4).unwrap())),
    ]
}

fn run(train: &Train, method: &mut dyn AssemblyMethod, name: &str, state: &mut AssemblyState, steps: u32) {
    for k in 0..steps {
        let step = method.step(&train.assembly, f64::from(k) * 0.02, 0.02, state);
        step.unwrap_or_else(|error| panic!("{name}, step {k}: {error}"));
    }
}

/// By every method a damped train comes to rest, and stays there: its remaining velocities are the rounding of its forces.
#[test]
#[ignore = "slow"]
fn a_damped_train_comes_to_rest() {
    let train = damped();
    for (name, mut method) in methods(&train) {
        let mut state = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[]);
        run(&train, method.as_mut(), name, &mut state, 12_000);
        // Forces of 7 N/m at places of a metre, over a step, and the last digits of hinges: in m/s and rad/s.
        let noise = 64.0 * f64::EPSILON * (7.0 * 0.02 + 1.0 / 0.02);
        for i in 0..state.len() {
            assert!(state.v()[i].abs() <= noise, "{name}: {:e}", state.v()[i]);
        }
        let before = state.unwrapped();
        run(&train, method.as_mut(), name, &mut state, 1000);
        for (i, before) in before.iter().enumerate() {
            assert!((state.unwrapped()[i] - before).abs() <= 1e-12, "{name}: {:e}", state.unwrapped()[i] - before);
        }
    }
}

#[test]
fn a_train_at_rest_stays() {
    stays_at_rest(20);
}

#[test]
#[ignore = "slow"]
fn a_train_at_rest_stays_in_full() {
    stays_at_rest(100);
}

/// Without forces a train at rest keeps its place to the last bit.
fn stays_at_rest(steps: u32) {
    let train = train(3);
    for (name, mut method) in methods(&train) {
        let start = train.start(&SleighState { x: 0.3, y: -0.7, heading: 0.4, ..SleighState::default() }, &[0.2, -0.1]);
        let mut state = start.clone();
        run(&train, method.as_mut(), name, &mut state, steps);
        for i in 0..state.len() {
            assert!((state.unwrapped()[i] - start.unwrapped()[i]).abs() <= 4.0 * f64::EPSILON, "{name}");
        }
    }
}
