//! The discrete Lagrange-d'Alembert step of the sleigh: its forms, symmetries, failures, and the turn-around.

#![allow(missing_docs, clippy::float_cmp, clippy::unwrap_used, clippy::expect_used)]

mod branches;
mod failures;
mod forms;
mod symmetry;
mod turnaround;
