//! The midpoint discrete Lagrange-d'Alembert map of the sleigh, reduced to one unknown, or to two where forces act: an integrator of the
//! sleigh's own, which agrees with [`Dla`] to rounding.

mod form;
mod free;
mod half_turn;
mod heading;
mod map;
mod mean_equations;
mod memory;
mod pushed;
mod spin_equation;
mod spin_memory;

pub use form::{ClosedForm, ClosedStart, ClosedStep};
pub use map::ClosedMap;
pub use memory::Memory;

#[cfg(doc)]
use dla::Dla;
