//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod methods;
mod systems;
mod with_basis;
