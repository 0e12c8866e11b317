//! The book: its commands are run, its links resolve, its blocks of Rust are tests, its pictures can be made again, and its
//! equations are numbered.

mod commands;
mod equations;
mod links;
mod pages;
