//! When an iteration has converged: the tests of all implicit methods, and their tolerances.
//!
//! Every component converges by itself, by its own correction; a tolerance on all together would freeze those that are small (a spin
//! that dies out exponentially, for one). A component whose corrections stall is decided by the backward error: where the residual of
//! every equation is a few roundings of the terms that it is the sum of, no better solution exists in this arithmetic, and the stalled
//! component has converged too. Elsewhere the iteration goes on, and where it does not converge the step is refused.
//!
//! The sizes of the terms come from a running error analysis of the very functions of the system, on the scalar
//! [`Rounded`](lagrangian::Rounded). They are asked for only where corrections stall above the round-off of the unknowns, so that
//! a usual step pays nothing.

mod corrections;
mod fixed_point;
mod residual;
pub mod tolerances;

pub(crate) use corrections::is_settled;
pub use corrections::{Convergence, CorrectionKind, Demand, rounding_of_place};
pub use fixed_point::FixedPoint;
pub(crate) use residual::{most_roundings, parted, without_reaction};
