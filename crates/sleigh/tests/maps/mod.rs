//! The maps of the sleigh by themselves: its explicit step, the planimeter's map of headings, plans that park it.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]

mod canonical;
mod headings;
mod moebius;
mod parking;
mod sizes;
