use dla::{AnyState, Mechanism};
use lagrangian::linear::larger;

/// A list of numbers: an array, or a vector where their number is not known before.
pub trait Quantities: AsRef<[f64]> + AsMut<[f64]> + Clone {}

impl<T: AsRef<[f64]> + AsMut<[f64]> + Clone> Quantities for T {}

/// A trajectory in a few numbers: its end, and extremes over the observed nodes.
///
/// `Q` is the list of the quantities, an array or a vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary<Q> {
    /// Time of the end (s).
    pub t: f64,
    /// The quantities at the end.
    pub end: Q,
    /// The least of each.
    pub low: Q,
    /// The largest of each.
    pub high: Q,
    /// Energy at the start and at the end (J).
    pub energy: [f64; 2],
    /// `max |E - E0|` (J): an error, where nothing does work.
    pub energy_deviation: f64,
    /// `max |A(q) v + b|`.
    pub constraint: f64,
}

/// Quantities of a time (s), a configuration, angles with their full turns, and a velocity.
pub(super) type Of<'a, Q> = &'a dyn Fn(f64, &[f64], &[f64]) -> Q;

impl<Q: Quantities> Summary<Q> {
    /// The summary of the first node alone.
    pub(super) fn first(system: &dyn Mechanism, t: f64, state: &AnyState, of: Of<'_, Q>) -> Self {
        let end = of(t, &state.unwrapped(), state.v());
        let energy = system.energy(t, state.q(), state.v());
        let (low, high) = (end.clone(), end.clone());
        let mut first = Self { t, end, low, high, energy: [energy; 2], energy_deviation: 0.0, constraint: 0.0 };
        first.look(system, t, state);
        first
    }

    /// Takes in one more node.
    pub(super) fn see(&mut self, system: &dyn Mechanism, t: f64, state: &AnyState, of: Of<'_, Q>) {
        (self.t, self.end) = (t, of(t, &state.unwrapped(), state.v()));
        for (k, value) in self.end.as_ref().iter().enumerate() {
            let (low, high) = (&mut self.low.as_mut()[k], &mut self.high.as_mut()[k]);
            (*low, *high) = (low.min(*value), high.max(*value));
        }
        self.energy[1] = system.energy(t, state.q(), state.v());
        self.look(system, t, state);
    }

    fn look(&mut self, system: &dyn Mechanism, t: f64, state: &AnyState) {
        self.energy_deviation = larger(self.energy_deviation, (self.energy[1] - self.energy[0]).abs());
        self.constraint = larger(self.constraint, system.largest_residual(t, state.q(), state.v()));
    }
}
