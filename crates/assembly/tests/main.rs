//! Assemblies against the static integrators and against what is known of trains.

#![allow(
    missing_docs,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "what clippy.toml allows in tests, their helpers need too"
)]

mod car;
mod chain;
mod cost;
mod long;
mod models;
mod rest;
mod same;
mod step;
mod tools;
mod train;
