//! The Lobatto methods: order, structure, failures.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
mod failures;
mod order;
mod sleigh_runs;
mod structure;
mod systems;
