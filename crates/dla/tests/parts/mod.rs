//! Steps that are made in parts: how a step is divided, when it resolves the motion, and what comes of steps that are far too long.

mod divided;
mod fields;
mod free;
mod halved;

use crate::support::ByHand;
use dla::{Composition, Dla, Energy, Gauss, Node, OneStep, Schedule, State, Substepping, Substeps, Trajectory, drive};
use lagrangian::System;
use sleigh::{Sleigh, SleighState};

/// The halves of every part agree to this part of the velocity. Ten parts of a turn that are wrong by that, all in the same sense,
/// lead astray by ten times as much.
const BAR: f64 = 1e-3;

/// A run with steps that may be divided.
struct Run {
    nodes: Vec<Node<3, 1>>,
    divided: u64,
    parts: u64,
}

impl Run {
    fn end(&self) -> SleighState {
        self.nodes.last().map(|node| SleighState::from_coordinates(&node.q, &node.v)).unwrap()
    }

    /// The speed and the spin at every node.
    fn seen(&self, of: fn(&SleighState) -> f64) -> Vec<f64> {
        self.nodes.iter().map(|node| of(&SleighState::from_coordinates(&node.q, &node.v))).collect()
    }
}

fn made<Sys, Method>(system: &Sys, method: Method, start: &SleighState, (step, steps): (f64, u64)) -> Run
where
    Sys: System<3, 1>,
    Method: OneStep<3, 1> + Clone,
{
    let (q, v) = start.to_coordinates();
    let mut state = State::new(q, v, [false, false, true]);
    let mut method = Substepping::within(method, Substeps::default()).resolving();
    let mut trajectory = Trajectory::every(1);
    let schedule = Schedule { t0: 0.0, step, steps };
    drive(system, &mut method, &schedule, &mut state, &mut trajectory).unwrap();
    // The blade does not slip at any node, by more than rounding of the velocities there.
    for node in trajectory.nodes() {
        let size = node.v.iter().fold(0.0, |sum, v| sum + v.abs());
        assert!(node.constraint <= 16.0 * f64::EPSILON * size, "t = {}: {:e}", node.t, node.constraint);
    }
    Run { nodes: trajectory.nodes().to_vec(), divided: method.divided(), parts: method.parts() }
}

/// A method of each family.
const EACH: &[&str] = &["dla", "dla4", "gauss8", "energy4"];

/// The run by one of them.
fn by<Sys: System<3, 1>>(name: &str, system: &Sys, start: &SleighState, steps: (f64, u64)) -> Run {
    match name {
        "dla" => made(system, Dla::midpoint(), start, steps),
        "dla4" => made(system, Composition::suzuki4(Dla::midpoint()), start, steps),
        "gauss8" => made(system, Gauss::new::<4>(), start, steps),
        _ => made(system, Energy::new::<2>(), start, steps),
    }
}

/// The runs by a method of each family.
fn by_each<Sys: System<3, 1>>(
    system: &Sys,
    start: &SleighState,
    steps: (f64, u64),
) -> impl Iterator<Item = (&'static str, Run)> {
    EACH.iter().map(move |name| (*name, by(name, system, start, steps)))
}

fn sleigh(offset: f64) -> Sleigh {
    Sleigh::new(1.0, 1.0, offset).unwrap()
}

/// The same, free.
fn free(offset: f64) -> ByHand {
    sleigh(offset).into()
}
