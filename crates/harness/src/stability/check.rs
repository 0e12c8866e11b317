//! What a recorded run shows: small functions, each of which measures one thing against its bar.

use super::{Recorded, Seen};
use lagrangian::linear::larger;

/// One thing, measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// What.
    pub what: &'static str,
    /// How much of it there is.
    pub measured: f64,
    /// How much there may be.
    pub bar: f64,
}

impl Finding {
    /// Whether it meets its bar; what is not a number does not.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.measured <= self.bar
    }

    /// The measured part of the bar, to find the worst of several.
    #[must_use]
    pub fn part(&self) -> f64 {
        if self.measured == 0.0 { 0.0 } else { self.measured / self.bar }
    }
}

/// The most that rounding can do in so many steps to a number of that size: some operations a step, each wrong by half an
/// ulp and all in the same sense. (Higham 2002, Accuracy and Stability of Numerical Algorithms, section 4.2.)
#[must_use]
pub fn rounding(steps: usize, size: f64) -> f64 {
    /// Operations in a step that one number of its result depends on.
    const OPERATIONS: f64 = 32.0;
    OPERATIONS * 0.5 * f64::EPSILON * (steps + 1) as f64 * size
}

/// The most that a method of the given order is wrong by, relative, over `length` time constants with steps of `part` of
/// one: the size of the terms that it leaves out, `part^order` for each. Beyond a part of one that is no bound.
#[must_use]
pub fn truncation(order: u32, part: f64, length: f64) -> f64 {
    length * part.powf(f64::from(order))
}

fn worst(of: impl Iterator<Item = f64>) -> f64 {
    of.fold(0.0, larger)
}

/// The constraint residual at the nodes, against some roundings of velocities of the given size.
#[must_use]
pub fn constraint(run: &Recorded, speed: f64) -> Finding {
    let measured = worst(run.nodes.iter().map(|node| node.constraint));
    Finding { what: "constraint residual", measured, bar: rounding(1, speed) }
}

/// The energy, the work taken off.
#[must_use]
pub fn energy(run: &Recorded, bar: f64) -> Finding {
    let measured = worst(run.nodes.iter().map(|node| node.energy_error));
    Finding { what: "energy error", measured, bar }
}

/// How many nodes have one of the values with another sign than the start; zero is another sign.
#[must_use]
pub fn sign_kept(run: &Recorded, value: usize) -> Finding {
    let sign = |node: &Seen| if node.values[value] == 0.0 { 0.0 } else { node.values[value].signum() };
    let first = run.nodes.first().map_or(0.0, sign);
    let changed = run.nodes.iter().filter(|node| sign(node).to_bits() != first.to_bits()).count();
    Finding { what: "nodes with the wrong sign", measured: changed as f64, bar: 0.0 }
}

/// The largest size of a value from the time `from` on (s).
#[must_use]
pub fn stays_below(run: &Recorded, value: usize, from: f64, bar: f64) -> Finding {
    let late = run.series(value).filter(|(t, _)| *t >= from);
    Finding { what: "largest size", measured: worst(late.map(|(_, x)| x.abs())), bar }
}

/// The largest distance of some values from where they should be at that time.
#[must_use]
pub fn follows<const K: usize>(
    run: &Recorded,
    values: [usize; K],
    expected: impl Fn(f64) -> [f64; K],
    bar: f64,
) -> Finding {
    let off = run.nodes.iter().map(|node| {
        let expected = expected(node.t);
        worst((0..K).map(|k| (node.values[values[k]] - expected[k]).abs()))
    });
    Finding { what: "distance from the closed form", measured: worst(off), bar }
}

/// The distance of some values at the end from where they should be; none where the run did not come so far.
#[must_use]
pub fn ends_at<const K: usize>(run: &Recorded, values: [usize; K], expected: [f64; K], bar: f64) -> Option<Finding> {
    let end = run.end()?;
    let measured = worst((0..K).map(|k| (end.values[values[k]] - expected[k]).abs()));
    Some(Finding { what: "distance at the end", measured, bar })
}

/// By how much something that is constant changes.
#[must_use]
pub fn constant(run: &Recorded, integral: impl Fn(&Seen) -> f64, bar: f64) -> Finding {
    let first = run.nodes.first().map_or(f64::NAN, &integral);
    let measured = worst(run.nodes.iter().map(|node| (integral(node) - first).abs()));
    Finding { what: "change of an integral", measured, bar }
}

/// How far two runs that should be images of one another are apart, node by node, in some values.
#[must_use]
pub fn agrees<const K: usize>(
    run: &Recorded,
    other: &Recorded,
    values: [usize; K],
    image: impl Fn(&Seen) -> [f64; K],
    bar: f64,
) -> Finding {
    let apart = run.nodes.iter().zip(&other.nodes).map(|(node, other)| {
        let image = image(other);
        worst((0..K).map(|k| (node.values[values[k]] - image[k]).abs()))
    });
    let measured = if other.nodes.is_empty() { f64::NAN } else { worst(apart) };
    Finding { what: "distance of two runs that are images of one another", measured, bar }
}

/// Something that was measured elsewhere.
#[must_use]
pub fn measured(what: &'static str, measured: f64, bar: f64) -> Finding {
    Finding { what, measured, bar }
}
