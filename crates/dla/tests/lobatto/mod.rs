//! The Lobatto methods: order, structure, failures.

pub(crate) mod failures;
mod order;
mod sleigh_runs;
mod structure;
pub(crate) mod systems;
