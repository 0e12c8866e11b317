//! The tests of the crate, in one program.

#![allow(missing_docs)]

mod bad_files;
mod files;
mod points;
mod random;
mod run_settings;
mod schema;
mod settings;
mod sweeps;
mod texts;
mod trailers;
