//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod common;
mod models;
mod particular;
