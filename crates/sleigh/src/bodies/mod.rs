//! Sleighs with more coordinates or more constraints than the free one.

mod flywheel;
mod guided;
mod guided_motion;
mod moments;
mod path;

pub use flywheel::Flywheel;
pub use guided::{Guide, Guided};
pub use path::{ClosedPath, PathShape, Polygon};

use crate::Sleigh;
use lagrangian::Piecewise;

impl Piecewise for Sleigh {
    fn piece(&self, _t: f64) -> Self {
        *self
    }
}
