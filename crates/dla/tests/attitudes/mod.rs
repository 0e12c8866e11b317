//! Attitudes of bodies that turn in space: by unit quaternions at any attitude, and by angles up to where they end.

pub(crate) mod angles;
mod chart;
pub(crate) mod cylinder;
mod length;
mod rolling;
mod tools;
