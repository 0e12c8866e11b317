//! The Lobatto methods: order, structure, failures.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
pub(crate) mod failures;
mod order;
mod sleigh_runs;
mod structure;
pub(crate) mod systems;
