//! The tests of the crate, in one program.

#![allow(
    missing_docs,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "what clippy.toml allows in tests, their helpers need too"
)]

mod bad_files;
mod files;
mod points;
mod random;
mod run_settings;
mod schema;
mod settings;
mod sweeps;
mod texts;
mod trailers;
