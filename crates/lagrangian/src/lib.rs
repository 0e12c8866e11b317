//! What a constrained mechanical system is.
//!
//! A [`System`] is a Lagrangian and a velocity constraint `A(q, t) v + b(q, t) = 0`, each written once as a function
//! generic in its [`Scalar`]. Everything else follows from the two: [momenta and energies](energy), the
//! [equations of motion](Motion), and the derivatives of a discrete Lagrangian by a [`Rule`]. Derivatives are exact, by [dual](Dual) [numbers](HyperDual), never by differences.
//!
//! This crate knows no integrator and no particular system.

mod along;
mod basis;
mod bordered;
mod bracket;
mod by_hand;
mod called;
mod classify;
mod compensated;
mod constraint_slopes;
mod curvature;
mod derived;
mod dual;
mod effect;
mod factored;
mod gradient;
mod gradients;
mod growth;
mod hessians;
mod hyperdual;
mod inverse;
mod lanes;
pub mod linear;
mod momentum;
mod motion;
mod octaves;
mod parametrised;
mod piecewise;
mod pivots;
mod power;
pub mod quadrature;
mod reaction;
mod reduced;
mod rounded;
mod rounding;
mod row_space;
mod rows;
mod rule;
mod saddle;
mod second;
mod seldom;
mod shown;
pub mod simd;
mod slopes;
mod smoothness;
mod system;
mod traced;
mod twofold;
mod with;
mod with_basis;

pub use along::acceleration_along;
pub use basis::AdmissibleBasis;
pub use bordered::Bordered;
pub use bracket::{Bracket, EnergySlope, energy_slope, inverse_reduced_mass};
pub use by_hand::{Reduced, StageEvaluation};
pub use called::Called;
pub use classify::{
    Classification, RowKind, classify, rank_is_constant, redundant_rows, row_space, rows_are_consistent,
};
pub use compensated::{added, two_sum};
pub use constraint_slopes::ConstraintSlopes;
pub use curvature::{add_position_curvature, add_reaction_curvature};
pub use dual::Dual;
pub use effect::{Effect, EffectSlope};
pub use factored::FactoredSaddle;
pub use gradient::Gradient;
pub use gradients::{Along, Gradients, Seeded, SeededMember};
pub use growth::{Growth, GrowthError, growth};
pub use hessians::{second_at_node, second_in_both, second_in_place, second_in_velocity};
pub use hyperdual::HyperDual;
pub use lanes::{Lanes, vectorized};
pub use momentum::{energy, mass_matrix, momentum};
pub use motion::{Motion, MotionError};
pub use octaves::{octaves, of_octaves};
pub use parametrised::{Member, Parametrised, Unparametrised};
pub use piecewise::{Piecewise, whole_steps};
pub use pivots::Pivots;
pub use power::{PowerSources, force_power, lagrangian_power};
pub use reaction::{position_misses, position_residual, position_rows, reaction_rows, rows_along};
pub use reduced::{
    ReducedError, ReducedSlope, derived_acceleration, quasi_velocities, reduced_acceleration, reduced_slope,
    velocity_of,
};
pub use rounded::Rounded;
pub use rounding::{MotionRounding, bracket_rounding, reduced_rounding};
pub use row_space::{Dependence, RowSpace};
pub use rows::Rows;
pub use rule::{Alpha, Midpoint, NotAWeight, Rule, RuleNode, Trapezoid};
pub use saddle::Saddle;
pub use scalar::{
    Scalar, ScalarFunction, array, assigning_operators, called, from_fn, mapped, mul_add, sin_cos_wrapped,
};
pub use second::{AT_ONCE, TwiceDifferentiable, second_derivatives, seed};
pub use seldom::{configuration_slope, velocity_slope};
pub use shown::Shown;
pub use slopes::{gradients, on_line, residual_along};
pub use smoothness::Smoothness;
pub use system::{Constraint, System, constraint_residual};
pub use traced::Traced;
pub use twofold::Twofold;
pub use with::With;
pub use with_basis::WithBasis;
