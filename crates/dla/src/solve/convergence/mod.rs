//! Convergence tests of all implicit methods, and their tolerances.
//!
//! Every component converges by itself, by its own correction; a tolerance on all together would freeze small components (for one, a spin
//! that dies out exponentially). A component whose corrections stall is judged by the backward error: if the residual of every equation is
//! a few roundings of its terms, no better solution exists in this arithmetic, and the stalled component has converged too. Otherwise the
//! iteration goes on, and if it does not converge the step is refused.
//!
//! The sizes of the terms come from a running error analysis of the very functions of the system, on the scalar
//! [`Rounded`](lagrangian::Rounded). They are evaluated only if corrections stall above the round-off of the unknowns, so that a usual step
//! pays nothing.

mod corrections;
mod fixed_point;
mod residual;
pub mod tolerances;

pub use corrections::{Convergence, CorrectionKind, Demand, rounding_of_place};
pub use fixed_point::FixedPoint;
pub(crate) use residual::{most_roundings, parted, without_reaction};
