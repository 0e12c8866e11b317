use super::isolate::isolate;
use super::root::{RootPoint, root};

/// A crossing of zero within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zero {
    /// The part of the step at which it is.
    pub at: f64,
    /// The width of what is known to hold it, as a part of the step.
    pub within: f64,
    /// Whether the function rises through zero.
    pub rising: bool,
}

/// The crossings within a step, parts of it from 0 to 1, of a function of which some values are known: pairs of a part and a
/// value in order, a little beyond both ends. Those in a direction that does not count are left out.
///
/// What [`Watch`](crate::Watch) says of what is missed and what is not holds here.
pub fn zeros(
    known: &[(f64, f64)],
    tolerance: f64,
    counts: impl Fn(bool) -> bool,
    mut f: impl FnMut(f64) -> f64,
) -> Vec<Zero> {
    searched(known, tolerance, &counts, &mut f)
}

/// The same, compiled once for every function.
fn searched(
    known: &[(f64, f64)],
    tolerance: f64,
    counts: &dyn Fn(bool) -> bool,
    mut f: &mut dyn FnMut(f64) -> f64,
) -> Vec<Zero> {
    let points: Vec<RootPoint> = known
        .iter()
        .map(|(at, value)| RootPoint { at: *at, value: *value })
        .filter(|point| !point.value.is_nan())
        .collect();
    let found = isolate(&points, &mut f).into_iter().filter(|(from, _)| counts(from.value < 0.0));
    let found: Vec<(RootPoint, RootPoint)> = found.collect();
    let zero = |(from, to): (RootPoint, RootPoint)| {
        let (at, within) = root(from, to, tolerance, &mut f);
        Zero { at, within, rising: from.value < 0.0 }
    };
    found.into_iter().map(zero).collect()
}

/// What is found at parts of a step, in the order of these.
pub(super) fn in_order<T>(mut found: Vec<(f64, T)>) -> impl Iterator<Item = T> {
    found.sort_by(|one, other| f64::total_cmp(&one.0, &other.0));
    found.into_iter().map(|(_, found)| found)
}
