//! Events: where a function of the state crosses zero along a run.

mod crossing;
mod isolate;
mod root;
mod watch;

pub use crossing::{Crossing, Direction, Event};
pub use watch::Watch;
