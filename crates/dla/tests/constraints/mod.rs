//! Constraints beyond independent linear ones: on positions, affine, not affine, dependent on one another.

mod affine;
pub(crate) mod classes;
pub(crate) mod driven;
pub(crate) mod holonomic;
mod nonlinear;
mod pseudo;
pub(crate) mod redundant;
pub(crate) mod starts;
mod tools;
