//! Attitudes of bodies that turn in space: by unit quaternions at any attitude, and by angles beside them.

pub(crate) mod angles;
pub(crate) mod cylinder;
mod length;
mod rolling;
mod tools;
