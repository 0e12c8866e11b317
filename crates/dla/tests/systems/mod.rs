//! The discrete Lagrange-d'Alembert step on small systems whose motion is known.

pub(crate) mod alternating;
pub(crate) mod continued;
pub(crate) mod degenerate;
pub(crate) mod driven;
mod forms;
mod free;
pub(crate) mod lanes;
pub(crate) mod models;
mod rules;
mod tools;
