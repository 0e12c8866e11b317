//! The Chaplygin sleigh: a rigid body on a plane, carried by a blade that cannot slip sideways.
//!
//! Coordinates, signs and acting points are those of [`Sleigh`]; the state that a person would write down is a
//! [`SleighState`]; [`Exact`] is the motion of the free sleigh in closed form. What acts on it is in [`effects`]; what gives it
//! other coordinates or another constraint is another body: [`Flywheel`], [`Guided`]. Its own integrators are in
//! [`closed`] (the midpoint map in closed form) and [`series`] (Taylor series). Its geometry, without any forces, is in
//! [`planimeter`] (what a led blade turns by) and [`parking`] (controls that reach a pose).

mod bodies;
mod body;
mod centre_of_mass;
pub mod closed;
pub mod effects;
mod error;
mod exact;
pub mod parking;
pub mod planimeter;
pub mod series;
mod system;
mod time_function;

pub use bodies::{ClosedPath, Flywheel, Guide, Guided, PathShape, Polygon};
pub use body::{Sleigh, SleighBody, SleighState};
pub use centre_of_mass::CentreOfMass;
pub use closed::ClosedMap;
pub use error::SleighError;
pub use exact::Exact;
pub use series::Taylor;
pub use time_function::{Formula, Pulses, Ramp, Table, TimeFunction};
