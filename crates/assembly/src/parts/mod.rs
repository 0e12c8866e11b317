//! Bodies, what runs under them, joints, and trains of blades.

mod blade;
mod body;
mod joints;
mod train;

pub use blade::{Blade, SteeredBlade};
pub use body::{Body, RotorElement};
pub use joints::{Hinge, Motor};
pub use train::{Trailer, Train};

use lagrangian::Piecewise;

/// Parts that never jump.
macro_rules! smooth {
    ($($part:ty),+) => {
        $(impl Piecewise for $part {
            fn piece(&self, _t: f64) -> Self {
                *self
            }
        })+
    };
}
smooth!(Blade, Body, RotorElement, SteeredBlade);
