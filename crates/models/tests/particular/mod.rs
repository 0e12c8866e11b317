//! What holds for single models: the geometry behind their constraints, known motions, what is refused.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

mod constrained;
mod geometry;
mod invariants;
mod measures;
mod motions;
mod refusals;
mod suslov;

/// Some ten terms below four, each rounded a few times.
const ROUNDING: f64 = 1e-13;
