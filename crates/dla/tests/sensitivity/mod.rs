//! First derivatives of steps against extrapolated differences, closed forms, and two runs.

mod closed_forms;
mod differences;
mod reduced;
mod refusals;
mod runs;
mod steps;
pub(crate) mod systems;
