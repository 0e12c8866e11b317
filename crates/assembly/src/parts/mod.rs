//! Bodies, joints and trains of blades.

mod hinge;
mod train;

pub use hinge::Hinge;
pub use train::{Train, Trailer};
