//! Curves of a chart, from the nodes of runs.

use harness::stability::Seen;
use report::{Chart, Layer};

pub(crate) const X: usize = 0;
pub(crate) const Y: usize = 1;
pub(crate) const SPEED: usize = 3;
pub(crate) const SPIN: usize = 4;

/// What an upright axis shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Upright {
    Linear,
    Decades,
}

/// A chart against the time.
pub(crate) fn in_time(title: &str, upright: &str, scale: Upright, layers: Vec<Layer>) -> Chart {
    chart(title, ["t [s]", upright], [false, scale == Upright::Decades], layers)
}

pub(crate) fn chart(title: &str, axes: [&str; 2], decades: [bool; 2], layers: Vec<Layer>) -> Chart {
    Chart { title: title.to_owned(), axes: axes.map(str::to_owned), decades, layers }
}

/// One curve with its name.
pub(crate) fn curve(label: &str, points: Vec<[f64; 2]>) -> Layer {
    Layer::Curves { label: label.to_owned(), curves: vec![points] }
}

/// Markers with their name.
pub(crate) fn markers(label: &str, points: impl IntoIterator<Item = [f64; 2]>) -> Layer {
    Layer::Curves { label: label.to_owned(), curves: points.into_iter().map(|point| vec![point]).collect() }
}

/// Something of the nodes against the time.
pub(crate) fn trace(label: &str, nodes: &[Seen], value: impl Fn(&Seen) -> f64) -> Layer {
    curve(label, nodes.iter().map(|node| [node.t, value(node)]).collect())
}

/// The same of what should be small, as its upper edge.
pub(crate) fn peaks(label: &str, nodes: &[Seen], value: impl Fn(&Seen) -> f64) -> Layer {
    curve(label, upper_edge(nodes.iter().map(|node| [node.t, value(node)])))
}

/// Of each of a hundred stretches of time the largest value.
pub(crate) fn upper_edge(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let points: Vec<_> = points.collect();
    let stretches = points.chunks(points.len().div_ceil(100).max(1));
    stretches.filter_map(|points| points.iter().copied().reduce(|a, b| if a[1] >= b[1] { a } else { b })).collect()
}

/// A level, such as a bar.
pub(crate) fn level(label: &str, value: f64, until: f64) -> Layer {
    curve(label, vec![[0.0, value], [until, value]])
}
