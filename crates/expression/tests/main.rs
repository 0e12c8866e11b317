//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod common;
mod hostile;
mod large;
mod parsing;
mod rust_text;
mod simplification;
mod tape;
mod values;
