//! The Chaplygin sleigh: a rigid body on a plane, carried by a blade that cannot slip sideways.
//!
//! Coordinates, signs and acting points are those of [`Sleigh`]; the state that a person would write down is a
//! [`SleighState`]; [`Exact`] is the motion of the free sleigh in closed form. What acts on it is in [`effects`]; what gives it
//! other coordinates or another constraint is another body: [`Flywheel`], [`Guided`], [`RoundWell`]. Its geometry, without any forces, is in
//! [`planimeter`] (what a led blade turns by) and [`parking`] (controls that reach a pose).

mod bodies;
mod body;
mod canonical;
mod centre_of_mass;
mod checks;
mod closed_lanes;
mod closed_map;
mod differences;
pub mod effects;
mod error;
mod exact;
mod foreseen;
mod half_turn;
mod heading;
mod least_spin;
mod mean_equations;
mod mean_memory;
pub mod parking;
pub mod planimeter;
mod pushed_map;
mod sleigh_body;
mod spin_equation;
mod spin_memory;
mod state;
mod system;
mod time_function;

pub use bodies::{ClosedPath, Flywheel, Guide, Guided, RoundWell};
pub use body::Sleigh;
pub use centre_of_mass::CentreOfMass;

pub use error::SleighError;
pub use exact::Exact;
pub use sleigh_body::SleighBody;
pub use state::SleighState;
pub use time_function::{Pulses, Table, TimeFunction};
