//! The report as a reader, a file system and a browser see it.

#![allow(
    missing_docs,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "what clippy.toml allows in tests, their helpers need too"
)]

mod animation;
mod browser;
mod charts;
mod colours;
mod common;
mod ends;
mod files;
mod page;
mod pictures;
mod raster;
mod sheet;
