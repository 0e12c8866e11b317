use super::isolate::isolate;
use super::root::{RootPoint, root};

/// A crossing of zero within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zero {
    /// The place of the crossing, as a part of the step.
    pub at: f64,
    /// The width of the bracket that holds it, as a part of the step.
    pub within: f64,
    /// Whether the function rises through zero.
    pub rising: bool,
}

/// The crossings within a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Zeros {
    /// In no order.
    pub zeros: Vec<Zero>,
    /// Whether the function has no value at a known point of the step, so that others may have been missed.
    pub incomplete: bool,
}

impl Zeros {
    /// These, or if some are missing the `others`, should they be more.
    pub(super) fn or(self, others: impl FnOnce() -> Self) -> Self {
        if !self.incomplete {
            return self;
        }
        let others = others();
        if others.zeros.len() > self.zeros.len() { others } else { self }
    }
}

/// The crossings of a function within a step, at parts of it from 0 to 1. `known` has pairs of a part and a value in order, a little beyond
/// both ends; a missing value is NaN. Crossings in a direction that does not count are left out.
///
/// [`Watch`](crate::Watch) describes which crossings may be missed.
pub fn zeros(known: &[(f64, f64)], tolerance: f64, counts: impl Fn(bool) -> bool, f: impl FnMut(f64) -> f64) -> Zeros {
    zeros_by(known, true, tolerance, counts, f)
}

/// As [`zeros`], for values that need not be exact: at a change of sign the function itself is evaluated.
pub(super) fn zeros_by(
    known: &[(f64, f64)],
    exact: bool,
    tolerance: f64,
    counts: impl Fn(bool) -> bool,
    mut f: impl FnMut(f64) -> f64,
) -> Zeros {
    searched((known, exact), tolerance, &counts, &mut f)
}

/// As [`zeros_by`], compiled once for every function.
fn searched(
    (known, exact): (&[(f64, f64)], bool),
    tolerance: f64,
    counts: &dyn Fn(bool) -> bool,
    mut f: &mut dyn FnMut(f64) -> f64,
) -> Zeros {
    let points = known.iter().map(|(at, value)| RootPoint { at: *at, value: *value });
    let (points, missing): (Vec<RootPoint>, Vec<RootPoint>) = points.partition(|point| !point.value.is_nan());
    let mut incomplete = missing.iter().any(|point| (0.0..=1.0).contains(&point.at));
    let mut zeros = Vec::new();
    for (mut from, mut to) in isolate(&points, &mut *f) {
        if !exact {
            let Some(bracket) = truly([from.at, to.at], from.value < 0.0, f) else {
                incomplete = true;
                continue;
            };
            (from, to) = bracket;
        }
        if counts(from.value < 0.0) {
            let (at, within) = root(from, to, tolerance, &mut f);
            zeros.push(Zero { at, within, rising: from.value < 0.0 });
        }
    }
    Zeros { zeros, incomplete }
}

/// The points of a change of sign of the function itself in a direction, at two places or within their distance beyond them; `None` if there
/// is no such change. In the other direction there is the neighbour of a close crossing, which has a bracket of its own.
fn truly([from, to]: [f64; 2], rising: bool, f: &mut dyn FnMut(f64) -> f64) -> Option<(RootPoint, RootPoint)> {
    /// Halves of the distance from the first place, the nearest first.
    const NEAREST: [[f64; 2]; 7] =
        [[0.0, 2.0], [0.0, 1.0], [1.0, 2.0], [-1.0, 0.0], [2.0, 3.0], [-2.0, -1.0], [3.0, 4.0]];
    NEAREST.into_iter().find_map(|halves| {
        let [from, to] = halves.map(|k| {
            let at = (from + 0.5 * k * (to - from)).clamp(0.0, 1.0);
            RootPoint { at, value: f(at) }
        });
        let crosses = if rising { from.value < 0.0 && to.value >= 0.0 } else { from.value > 0.0 && to.value <= 0.0 };
        crosses.then_some((from, to))
    })
}

/// Items found at parts of a step, in the order of the parts.
pub(super) fn in_order<T>(mut found: Vec<(f64, T)>) -> impl Iterator<Item = T> {
    found.sort_by(|one, other| f64::total_cmp(&one.0, &other.0));
    found.into_iter().map(|(_, found)| found)
}
