//! The report as a reader, a file system and a browser see it.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod animation;
mod browser;
mod colours;
mod common;
mod ends;
mod figure;
mod files;
mod page;
mod pictures;
mod raster;
