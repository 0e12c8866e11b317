use dla::{Mechanics, State};
use lagrangian::linear::larger;

/// A trajectory in a few numbers: its end, and extremes over the observed nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary<const K: usize> {
    /// Time of the end (s).
    pub t: f64,
    /// The quantities at the end.
    pub end: [f64; K],
    /// The least of each.
    pub low: [f64; K],
    /// The largest of each.
    pub high: [f64; K],
    /// Energy at the start and at the end (J).
    pub energy: [f64; 2],
    /// `max |E - E0|` (J): an error, where nothing does work.
    pub energy_deviation: f64,
    /// `max |A(q) v + b|`.
    pub constraint: f64,
}

impl<const K: usize> Summary<K> {
    /// A summary before the first node.
    pub(super) fn new() -> Self {
        Self {
            t: 0.0,
            end: [0.0; K],
            low: [f64::INFINITY; K],
            high: [f64::NEG_INFINITY; K],
            energy: [f64::NAN; 2],
            energy_deviation: 0.0,
            constraint: 0.0,
        }
    }

    /// Takes in one more node.
    pub(super) fn see<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        state: &State<N>,
        of: impl Fn(&[f64; N], &[f64; N]) -> [f64; K],
    ) {
        (self.t, self.end) = (t, of(&state.unwrapped(), state.v()));
        for k in 0..K {
            (self.low[k], self.high[k]) = (self.low[k].min(self.end[k]), self.high[k].max(self.end[k]));
        }
        self.energy[1] = system.energy(t, state.q(), state.v());
        if self.energy[0].is_nan() {
            self.energy[0] = self.energy[1];
        }
        self.energy_deviation = larger(self.energy_deviation, (self.energy[1] - self.energy[0]).abs());
        let residual = system.residual(t, state.q(), state.v());
        self.constraint = residual.iter().fold(self.constraint, |most, residual| larger(most, residual.abs()));
    }
}
