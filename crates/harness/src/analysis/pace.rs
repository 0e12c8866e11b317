use super::returns::{Point, Returns, apart, size};
use super::verdict::PARTS;
use crate::Blocks;

/// The course of the quasi-velocities along a run: whether they change, grow or repeat.
#[derive(Debug)]
pub(super) struct Pace {
    /// Factors that make each of them the root of twice its energy.
    weights: Vec<f64>,
    /// The first step that is counted, and the first step at which repetitions are looked for.
    counted: u64,
    half: u64,
    sizes: Blocks,
    largest: f64,
    origin: Option<Vec<f64>>,
    change: f64,
    quickest: f64,
    last: Option<Point>,
    returns: Option<Returns>,
}

impl Pace {
    pub(super) fn new(weights: Vec<f64>, settle: u64, steps: u64) -> Self {
        Self {
            weights,
            counted: settle,
            half: settle.saturating_add(steps / 2),
            sizes: Blocks::default(),
            largest: 0.0,
            origin: None,
            change: 0.0,
            quickest: 0.0,
            last: None,
            returns: None,
        }
    }

    /// Adds node `k`, with its quasi-velocities and their rates.
    pub(super) fn add(&mut self, k: u64, t: f64, xi: &[f64], rate: &[f64]) {
        let scaled = |x: &[f64]| -> Vec<f64> { self.weights.iter().zip(x).map(|(weight, x)| weight * x).collect() };
        let point = (t, scaled(xi), scaled(rate));
        self.sizes.add(t, size(&point.1));
        self.largest = self.largest.max(size(&point.1));
        if k >= self.counted {
            let origin = self.origin.get_or_insert_with(|| point.1.clone());
            self.change = self.change.max(apart(&point.1, origin));
            self.quickest = self.quickest.max(size(&point.2));
        }
        if k >= self.half {
            match (&mut self.returns, &self.last) {
                (Some(returns), Some(last)) => returns.add(last, &point),
                // A plane across a quick change is well crossed.
                _ if self.quickest > 0.0 && size(&point.2) >= 0.5 * self.quickest => {
                    self.returns = Some(Returns::to(point.clone()));
                }
                _ => {}
            }
        }
        self.last = Some(point);
    }

    /// The largest size of the whole run.
    pub(super) fn largest(&self) -> f64 {
        self.largest
    }

    /// The largest distance from the point at which the count began.
    pub(super) fn change(&self) -> f64 {
        self.change
    }

    /// The largest size in each part of the run.
    pub(super) fn maxima(&self) -> Option<[f64; PARTS]> {
        self.sizes.maxima()
    }

    pub(super) fn period(&self) -> Option<f64> {
        self.returns.as_ref().and_then(Returns::period)
    }
}
