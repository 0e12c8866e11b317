//! The energy-preserving methods: orders, energy and constraint over long runs, discrete work, refusals.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod balance;
pub(crate) mod order;
pub(crate) mod refusals;
mod structure;
pub(crate) mod systems;
