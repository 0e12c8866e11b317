//! The Chaplygin sleigh: a rigid body on a plane, carried by a blade that cannot slip sideways.
//!
//! Coordinates, signs and acting points are those of [`Sleigh`]; the state that a person would write down is a
//! [`SleighState`]; [`Exact`] is the motion of the free sleigh in closed form.

mod body;
mod centre_of_mass;
mod closed_map;
mod error;
mod exact;
mod state;
mod system;

pub use body::Sleigh;
pub use centre_of_mass::CentreOfMass;
pub use error::SleighError;
pub use exact::Exact;
pub use state::SleighState;
