//! The sleigh's own integrators: the map in closed form, and Taylor series.

mod lanes;
mod map;
mod taylor;
