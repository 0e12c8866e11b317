//! When an iteration has solved its equations: the tests of all implicit methods, and their tolerances.
//!
//! Every component settles by itself, by its own correction; a tolerance on all together would freeze those that are small (a spin
//! that dies out exponentially, for one). A component whose corrections no longer shrink is decided by the backward error: where
//! the residual of every equation is a few roundings of the terms that it is the sum of, nothing better can be found in these
//! digits, and the stalled component is settled too. Elsewhere the search goes on, and where it leads nowhere the step is refused.
//!
//! The sizes of the terms come from a running error analysis of the very functions of the system, on the scalar
//! [`Rounded`](lagrangian::Rounded). They are asked for only where corrections stall above the rounding of the unknowns, so that
//! a usual step pays nothing.

mod corrections;
mod fixed_point;
mod residual;
pub mod tolerances;

pub(crate) use corrections::is_settled;
pub use corrections::{Convergence, Demand, Kind, rounding_of_place};
pub use fixed_point::FixedPoint;
pub(crate) use residual::{most_roundings, parted, without_reaction};
