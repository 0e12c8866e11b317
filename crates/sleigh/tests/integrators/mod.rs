//! The sleigh's own integrators: the map in closed form, and Taylor series.

mod map;
mod taylor;
