//! The report as a reader, a file system and a browser see it.

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
