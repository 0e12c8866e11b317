//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod family;
mod models;
mod words;
