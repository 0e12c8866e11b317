//! Many trajectories at once, one in each lane: what the starts of an ensemble are integrated with.

mod closed;
mod collocation;
mod gauss;
mod state;
mod systems;

pub use closed::ClosedEnsemble;
pub use gauss::GaussEnsemble;
pub use state::LaneState;
pub use systems::{Each, Same, Systems};
