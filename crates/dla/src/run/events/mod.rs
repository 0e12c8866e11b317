//! Events: zero crossings of functions of the state along a run.

mod close_crossings;
mod crossing;
mod finer;
mod interval;
mod isolate;
mod root;
mod watch;
mod zeros;

pub use close_crossings::{Close, close_crossings};
pub use crossing::{Crossing, Direction, Event};
pub use watch::Watch;
pub use zeros::{Zero, Zeros, zeros};
