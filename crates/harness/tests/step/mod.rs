//! The discrete Lagrange-d'Alembert step of the sleigh: its forms, symmetries, failures, and the turn-around.

mod branches;
mod failures;
mod forms;
mod symmetry;
mod turnaround;
