//! The book: its commands are run, its figures are those of the program, its links resolve, its blocks of Rust are tests, its pictures
//! can be made again, and its equations are numbered.

mod commands;
mod equations;
mod figures;
mod links;
mod pages;
