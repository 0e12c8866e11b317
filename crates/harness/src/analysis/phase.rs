use dla::{AnyState, Observer, Report, View};
use std::ops::ControlFlow;

/// How far a coordinate has moved after every round of `every` steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Rounds {
    coordinate: usize,
    every: u64,
    start: Option<AnyState>,
    moved: Vec<f64>,
}

impl Rounds {
    /// Watches coordinate `coordinate` over rounds of `every` steps.
    #[must_use]
    pub fn new(coordinate: usize, every: u64) -> Self {
        Self { coordinate, every: every.max(1), start: None, moved: Vec::new() }
    }

    /// How far the coordinate has moved since the start, after each round.
    #[must_use]
    pub fn moved(&self) -> &[f64] {
        &self.moved
    }

    /// How far it moved in each round.
    #[must_use]
    pub fn each(&self) -> Vec<f64> {
        let before = std::iter::once(0.0).chain(self.moved.iter().copied());
        self.moved.iter().zip(before).map(|(after, before)| after - before).collect()
    }
}

impl Observer for Rounds {
    fn start(&mut self, node: &View<'_>) {
        self.start = Some(node.state.clone());
    }

    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        if let Some(start) = &self.start
            && node.k.is_multiple_of(self.every)
        {
            self.moved.extend(node.state.moved_since(start).get(self.coordinate));
        }
        ControlFlow::Continue(())
    }
}

/// The mean of a quasi-periodic sequence, faster than any power of its length.
///
/// The weights `exp(-1/(s (1 - s)))`, `s` the place in the sequence from 0 to 1, vanish smoothly at its ends; a plain mean has an error of
/// one over the length. (Das, Sander, Yorke and others 2017, Nonlinearity 30, 4111-4140.) `None` for an empty sequence.
#[must_use]
pub fn weighted_mean(sequence: &[f64]) -> Option<f64> {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (k, x) in sequence.iter().enumerate() {
        let s = (k as f64 + 0.5) / sequence.len() as f64;
        let weight = (-1.0 / (s * (1.0 - s))).exp();
        sum += weight * x;
        weights += weight;
    }
    (weights > 0.0).then(|| sum / weights)
}
