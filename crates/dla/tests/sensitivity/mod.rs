//! First derivatives of steps against extrapolated differences, closed forms, and two runs.

#![allow(missing_docs, unreachable_pub, clippy::unwrap_used, clippy::expect_used)]

mod closed_forms;
mod differences;
mod reduced;
mod refusals;
mod runs;
mod steps;
pub(crate) mod systems;
