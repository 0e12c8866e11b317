//! The sleigh of the scene `bowl`, typed.

use dla::State;
use lagrangian::{System, With};
use sleigh::effects::Bowl;
use sleigh::{Sleigh, SleighError, SleighState};

/// The sleigh in a round bowl.
pub type InBowl = With<Sleigh, Bowl>;

/// The step of the scene (s).
pub const STEP: f64 = 0.05;

/// The system and the start of the scene `bowl`, with a turn rate (rad/s), 0.1 in the scene.
///
/// # Errors
/// None: its numbers are valid.
pub fn bowl(turn_rate: f64) -> Result<(InBowl, State<3>), SleighError> {
    let body = Sleigh::new(1.0, 1.0, 0.5)?;
    let system = With { body, effects: Bowl::new([0.1, 0.1], [0.0, 0.0])? };
    let (q, v) = SleighState { speed: -1.0, turn_rate, ..SleighState::default() }.to_coordinates();
    let state = State::new(q, v, System::<3, 1>::angles(&system));
    Ok((system, state))
}
