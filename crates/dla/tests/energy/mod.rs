//! The energy-preserving methods: orders, energy and constraint over long runs, discrete work, refusals.

mod balance;
pub(crate) mod order;
pub(crate) mod refusals;
mod structure;
pub(crate) mod systems;
