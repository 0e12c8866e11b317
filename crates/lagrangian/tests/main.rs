//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod blocks;
mod common;
mod corners;
mod derivatives;
mod discrete;
mod effects;
mod lanes;
mod linear;
mod quadrature;
mod scalars;
