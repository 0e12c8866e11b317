//! Constraints beyond independent linear ones: on positions, affine, not affine, dependent on one another.

#![allow(missing_docs, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

mod affine;
pub(crate) mod classes;
pub(crate) mod driven;
pub(crate) mod holonomic;
mod nonlinear;
mod pseudo;
pub(crate) mod redundant;
pub(crate) mod starts;
mod tools;
