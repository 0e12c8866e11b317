//! Bodies, what runs under them, joints, and trains of blades.

mod blade;
mod body;
mod hinge;
mod motor;
mod train;

pub use blade::{Blade, SteeredBlade};
pub use body::{Body, RotorElement};
pub use hinge::Hinge;
pub use motor::Motor;
pub use train::{Trailer, Train};
