//! The tests of the program, in one program: what it prints, writes and refuses, and what the book says of it.

#![allow(missing_docs)]

mod book;
mod cli;
#[path = "common/processes.rs"]
mod processes;
#[path = "common/program.rs"]
mod program;
