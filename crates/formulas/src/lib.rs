//! What the texts of a system mean: coordinates, a Lagrangian, constraints and forces, written as formulas, checked and derived.
//!
//! 1. [`Words`] are the texts of a system, as a file or a program has them.
//! 2. [`Formulas`] are what they mean. A [`TextError`] says which text is wrong, in which column, and what is known there.
//! 3. [`ReducedFormulas`] are the equations of motion in a basis of the admissible velocities, derived of these.
//!
//! No number is computed here: that is for tapes (the crate `text`), or for a compiler (the crate `macros`).

mod basis;
mod build;
mod error;
mod formulas;
mod period;
mod reduced;
mod tables;
mod words;

pub use basis::RowElimination;
pub use error::{Entry, Problem, TextError};
pub use formulas::{Formulas, Parameters};
pub use reduced::ReducedFormulas;
pub use words::{Unit, Words};
