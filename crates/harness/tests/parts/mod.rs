//! What comes of steps that are far too long and are made in parts.

mod fields;
mod free;

use crate::common::sleigh_at;
use crate::common::watched;
use dla::{Node, PiecewiseMechanics, Schedule, Subject, Substeps};
use harness::{Method, Request, SubstepSummary};
use sleigh::{Sleigh, SleighState};

/// The halves of every part agree to this part of the velocity. Ten parts of a turn that are wrong by that, all in the same sense,
/// lead astray by ten times as much.
const BAR: f64 = 1e-3;

/// A run with steps that may be divided.
struct Run {
    nodes: Vec<Node>,
    substeps: SubstepSummary,
}

impl Run {
    fn end(&self) -> SleighState {
        self.nodes.last().map(|node| sleigh_at(&node.q, &node.v)).unwrap()
    }

    /// The speed or the spin at every node.
    fn seen(&self, of: fn(&SleighState) -> f64) -> Vec<f64> {
        self.nodes.iter().map(|node| of(&sleigh_at(&node.q, &node.v))).collect()
    }
}

fn request(start: &SleighState, (step, steps): (f64, u64)) -> Request {
    let (q, v) = start.to_coordinates();
    Request { schedule: Schedule { t0: 0.0, step, steps }, q: q.into(), v: v.into(), samples: 2 }
}

/// The run by the method of that name.
fn by(name: &str, system: &impl PiecewiseMechanics<3, 1>, start: &SleighState, steps: (f64, u64)) -> Run {
    let method = Method::named(name, None).unwrap().with_substeps(Substeps::default());
    let made = watched(&Subject::from(system), &method, &request(start, steps), &[], 1);
    assert!(made.record.failure.is_none(), "{name}: {:?}", made.record.failure);
    let nodes = made.nodes;
    // The blade does not slip at any node, by more than rounding of the velocities there.
    for node in &nodes {
        let size = node.v.iter().fold(0.0, |sum, v| sum + v.abs());
        assert!(node.constraint <= 16.0 * f64::EPSILON * size, "t = {}: {:e}", node.t, node.constraint);
    }
    Run { nodes, substeps: made.record.substeps.unwrap() }
}

/// A method of each family.
const EACH: &[&str] = &["dla", "dla4", "gauss8", "energy4"];

/// The runs by a method of each family.
fn by_each(
    system: &impl PiecewiseMechanics<3, 1>,
    start: &SleighState,
    steps: (f64, u64),
) -> impl Iterator<Item = (&'static str, Run)> {
    EACH.iter().map(move |name| (*name, by(name, system, start, steps)))
}

fn sleigh(offset: f64) -> Sleigh {
    Sleigh::new(1.0, 1.0, offset).unwrap()
}
