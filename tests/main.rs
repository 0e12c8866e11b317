//! The tests of the program, in one program: what it prints, writes and refuses, and what the book says of it.

#![allow(
    missing_docs,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "what clippy.toml allows in tests, their helpers need too"
)]

mod book;
mod cli;
mod processes;
mod program;
