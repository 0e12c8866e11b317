//! The midpoint discrete Lagrange-d'Alembert map of the sleigh, reduced to one unknown, or to two where forces act: an integrator of the
//! sleigh's own, which agrees with [`Dla`] to rounding.

mod differences;
mod foreseen;
mod form;
mod free;
mod half_turn;
mod heading;
mod least_spin;
mod map;
mod mean_equations;
mod mean_memory;
mod memory;
mod push;
mod pushed;
mod settling;
mod spin_equation;
mod spin_memory;
mod step;

pub use form::ClosedForm;
pub use map::ClosedMap;
pub use memory::Memory;
pub use push::Push;
pub use step::{ClosedStart, ClosedStep};

#[cfg(doc)]
use dla::Dla;
