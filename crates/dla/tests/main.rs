//! The tests of the crate, in one program: a method is compiled once for a shape, and not once in
//! each of a dozen.

#![allow(
    missing_docs,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "what clippy.toml allows in tests, their helpers need too"
)]

mod attitudes;
mod constraints;
mod corners;
mod drive;
mod effects;
mod energy;
mod large;
mod lobatto;
mod newton;
mod parts;
mod rest;
mod runs;
mod sensitivity;
mod state;
mod support;
mod systems;
