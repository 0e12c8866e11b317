//! The sleigh's own integrators: the map in closed form, and Taylor series.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

mod lanes;
mod map;
mod taylor;
