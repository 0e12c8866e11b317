//! The upright axis of what should stay zero.

use super::axis::{self, Tick};
use super::geometry::{PlotFrame, Span};

/// Values that many decades below the usual ones of the most exact method say no more than that they are small.
const BELOW: f64 = 8.0;
/// Values that many decades above it say no more than that a method has blown up.
const ABOVE: f64 = 24.0;

/// The time and the size of each peak, in order; nothing where the values are not finite.
pub(super) type Trace = Vec<Option<[f64; 2]>>;

/// Methods within so many decades of the most exact one are as exact.
const NEAR: f64 = 1.5;

/// The upright axis: decades, the lowest of which is a line for all that is smaller, or zero.
#[derive(Debug)]
pub(super) struct Scale {
    lo: f64,
    hi: f64,
    /// Where and what that line is, where something lies on it.
    pub(super) floor: Option<Tick>,
}

impl Scale {
    /// For these traces; of which nothing below the decade `least` is more than rounding.
    pub(super) fn of(traces: &[Trace], least: f64) -> Self {
        let all: Vec<f64> = traces.iter().flatten().flatten().map(|point| point[1]).collect();
        let best = traces.iter().filter_map(usual).fold(f64::INFINITY, f64::min).log10();
        let worth = |log: &f64| *log >= best - BELOW && *log <= best + ABOVE;
        let logs = Span::of(all.iter().filter(|size| **size > 0.0).map(|size| size.log10()).filter(worth));
        // Where everything is zero, the decades below it show what it is smaller than.
        let Span { lo, hi } = logs.unwrap_or(Span { lo: -17.0, hi: -14.5 });
        // Where the most exact method has zeros, its other values are rounding too: they come and go from node to node.
        let rounds = |trace: &&Trace| {
            let near = usual(trace).is_none_or(|size| size.log10() < best + NEAR);
            near && trace.iter().skip(1).flatten().any(|point| point[1] <= 0.0)
        };
        let rounding = traces.iter().find(rounds).and(best.is_finite().then_some(best.ceil()));
        let lo = rounding.unwrap_or((lo + 1e-9).floor()).max(least);
        // The highest peak is not to touch the upper edge.
        let hi = (hi + 0.08).ceil().max(lo + 1.0);
        let smaller = all.iter().any(|size| *size > 0.0 && size.log10() < lo);
        let zero = all.iter().any(|size| *size <= 0.0);
        let floor = (smaller || zero).then(|| (lo, format!("≤ {}", power(lo))));
        Self { lo, hi, floor }
    }

    /// Whether some value lies above the axis.
    pub(super) fn leaves(&self, trace: &Trace) -> bool {
        trace.iter().flatten().any(|[_, size]| size.log10() > self.hi)
    }

    pub(super) fn span(&self) -> Span {
        let lo = self.floor.as_ref().map_or(self.lo, |(floor, _)| floor - 0.05 * (self.hi - floor));
        Span { lo, hi: self.hi }
    }

    pub(super) fn ticks(&self) -> Vec<Tick> {
        let rough = (self.hi - self.lo) / 7.0;
        let step = [1.0, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0, 50.0].into_iter().find(|step| *step >= rough).unwrap_or(100.0);
        // The floor has a tick of its own.
        let first = ((self.lo + if self.floor.is_some() { 0.5 * step } else { 0.0 }) / step).ceil();
        let decades = (0..20).map(|k| (first + f64::from(k)) * step).take_while(|decade| *decade <= self.hi);
        decades.map(|decade| (decade, power(decade))).chain(self.floor.clone()).collect()
    }

    pub(super) fn place(&self, frame: &PlotFrame, point: Option<[f64; 2]>) -> Option<[f64; 2]> {
        let [time, size] = point?;
        let log = if size > 0.0 { size.log10() } else { f64::NEG_INFINITY };
        frame.place([time, log.max(self.lo)])
    }
}

/// The middle one of the sizes that are not zero: a peak does not move it, and neither does a dip.
fn usual(trace: &Trace) -> Option<f64> {
    let mut sizes: Vec<f64> = trace.iter().flatten().map(|point| point[1]).filter(|size| *size > 0.0).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied()
}

fn power(decade: f64) -> String {
    format!("10{}", axis::superscript(&format!("{decade:.0}")))
}
