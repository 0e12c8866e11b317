//! Attitudes of bodies that turn in space: by unit quaternions at any attitude, and by angles up to where they end.

#![allow(missing_docs, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

pub(crate) mod angles;
mod chart;
pub(crate) mod cylinder;
mod length;
mod rolling;
mod tools;
