//! What holds for single models: the geometry behind their constraints, known motions, what is refused.

mod constrained;
mod geometry;
mod invariants;
mod measures;
mod motions;
mod refusals;
mod suslov;

/// Some ten terms below four, each rounded a few times.
const ROUNDING: f64 = 1e-13;
