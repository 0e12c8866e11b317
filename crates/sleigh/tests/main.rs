//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod effects;
mod exact;
mod exact_symmetries;
mod integrators;
mod maps;
mod system;
