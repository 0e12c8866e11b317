//! The equations that follow from a system, by exact derivatives.

mod along;
mod bracket;
mod momentum;
mod motion;
mod power;
mod reaction;
mod reduced;
mod rounding;
mod second;
mod slopes;

pub use along::acceleration_along;
pub use bracket::{Bracket, EnergySlope, energy_slope, inverse_on_basis, inverse_reduced_mass};
pub use momentum::{energy, gradient_in_velocity, mass_matrix, momentum};
pub(crate) use motion::solved;
pub use motion::{Motion, MotionError};
pub use power::{PowerSources, Smoothness, force_power, lagrangian_power};
pub use reaction::{position_misses, position_residual, position_rows, reaction_rows, rows_along, within_rounding};
pub(crate) use reduced::shortest;
pub use reduced::{
    ReducedError, ReducedSlope, derived_acceleration, quasi_velocities, reduced_acceleration, reduced_from_motion,
    reduced_slope, velocity_of,
};
pub use rounding::{MotionRounding, bracket_rounding, configuration_slope, reduced_rounding, velocity_slope};
pub use second::{
    AT_ONCE, TwiceDifferentiable, add_position_curvature, add_reaction_curvature, second_along, second_derivatives,
    seed,
};
pub(crate) use second::{BLOCK, second_in_velocity};
pub(crate) use slopes::gradient_in_place;
pub use slopes::{ConstraintSlopes, gradients, on_line, residual_along};
