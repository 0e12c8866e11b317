//! The discrete Lagrange-d'Alembert step on small systems whose motion is known.

#![allow(missing_docs, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

mod alternating;
mod continued;
mod degenerate;
mod driven;
mod forms;
mod free;
mod lanes;
mod models;
mod tools;
