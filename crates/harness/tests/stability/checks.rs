//! Checks of a recorded run.

use harness::stability::check::{self, Finding, largest, measured, rounding};
use harness::stability::{Recorded, Seen};

/// The constraint residual at the nodes, against some roundings of velocities of the given size.
pub(crate) fn constraint(run: &Recorded, speed: f64) -> Finding {
    largest("constraint residual", run.nodes.iter().map(|node| node.constraint), rounding(1, speed))
}

/// The energy, the work taken off.
pub(crate) fn energy(run: &Recorded, bar: f64) -> Finding {
    largest("energy error", run.nodes.iter().map(|node| node.energy_error), bar)
}

/// Whether one of the values keeps its sign.
pub(crate) fn sign_kept(run: &Recorded, value: usize) -> Finding {
    check::sign_kept(run.nodes.iter().map(|node| node.values[value]))
}

/// The largest size of a value from the time `from` on (s).
pub(crate) fn stays_below(run: &Recorded, value: usize, from: f64, bar: f64) -> Finding {
    largest("largest size", run.nodes.iter().filter(|node| node.t >= from).map(|node| node.values[value]), bar)
}

fn apart<const K: usize>(node: &Seen, values: [usize; K], expected: [f64; K]) -> f64 {
    largest("", (0..K).map(|k| node.values[values[k]] - expected[k]), 0.0).measured
}

/// The largest distance of some values from where they should be at that time.
pub(crate) fn follows<const K: usize>(
    run: &Recorded,
    values: [usize; K],
    expected: impl Fn(f64) -> [f64; K],
    bar: f64,
) -> Finding {
    largest("distance from the closed form", run.nodes.iter().map(|node| apart(node, values, expected(node.t))), bar)
}

/// The distance of some values at the end from where they should be; none where the run did not come so far.
pub(crate) fn ends_at<const K: usize>(
    run: &Recorded,
    values: [usize; K],
    expected: [f64; K],
    bar: f64,
) -> Option<Finding> {
    run.end().map(|end| measured("distance at the end", apart(end, values, expected), bar))
}

/// By how much something that is constant changes.
pub(crate) fn constant(run: &Recorded, integral: impl Fn(&Seen) -> f64, bar: f64) -> Finding {
    check::constant(run.nodes.iter().map(integral), bar)
}

/// How far two runs that should be images of one another are apart, node by node, in some values.
pub(crate) fn agrees<const K: usize>(
    run: &Recorded,
    other: &Recorded,
    values: [usize; K],
    image: impl Fn(&Seen) -> [f64; K],
    bar: f64,
) -> Finding {
    let pairs = run.nodes.iter().zip(&other.nodes);
    largest("distance of two images", pairs.map(|(node, other)| apart(node, values, image(other))), bar)
}
