//! Many trajectories at once, one in each lane: what the starts of an ensemble are integrated with.

mod closed;
mod state;

pub use closed::ClosedEnsemble;
pub use state::LaneState;
