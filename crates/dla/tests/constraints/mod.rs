//! Constraints beyond independent linear ones: on positions, affine, not affine, dependent on one another.

#![allow(missing_docs, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

mod affine;
mod classes;
mod driven;
mod holonomic;
mod nonlinear;
mod pseudo;
mod redundant;
mod starts;
mod tools;
