//! The energy-preserving methods: orders, energy and constraint over long runs, discrete work, refusals.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod balance;
mod order;
mod refusals;
mod structure;
mod systems;
