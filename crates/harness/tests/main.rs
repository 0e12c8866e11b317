//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod allocation;
mod common;
mod geometry;
mod report;
mod runs;
mod stability;
mod step;
mod table;
