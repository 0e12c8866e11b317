//! The discrete Lagrange-d'Alembert step on small systems whose motion is known.

#![allow(missing_docs, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

pub(crate) mod alternating;
pub(crate) mod continued;
pub(crate) mod degenerate;
pub(crate) mod driven;
mod forms;
mod free;
pub(crate) mod lanes;
pub(crate) mod models;
mod tools;
