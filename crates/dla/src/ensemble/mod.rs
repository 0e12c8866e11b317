//! Many trajectories at once, one in each lane: what the starts of an ensemble are integrated with.

mod collocation;
mod eight;
mod gauss;
mod order;
mod settling;
mod stages;
mod state;
mod step;
mod systems;

pub use gauss::GaussEnsemble;
pub use state::{LaneState, Row, accumulate, loaded, store};
pub use systems::{Each, Same, Systems};

/// Trajectories that go side by side in the registers of a machine.
pub const LANES: usize = 8;

/// After so many steps angles are wrapped, and frames computed from the configurations again, so that their round-off does not add up.
pub const BLOCK: u64 = 64;

/// `W` trajectories that make their steps together.
pub trait Ensemble<const N: usize, const W: usize> {
    /// Makes steps. A trajectory whose step is not found becomes NaN, and the others go on.
    fn advance(&mut self, steps: u64);

    /// The states.
    fn state(&self) -> &LaneState<N, W>;
}
