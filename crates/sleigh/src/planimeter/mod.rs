//! Prytz's planimeter in closed form: how a tracer that runs a path turns the blade that it leads.

mod holonomy;
mod moebius;

pub use holonomy::{Holonomy, Leg, of_curve, of_legs};
pub(crate) use moebius::wrapped;
pub use moebius::{Class, Moebius};
