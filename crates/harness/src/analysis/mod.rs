//! Analyses of motions: what is steady, and how stable; what a loop leaves behind; what a symmetry conserves.

mod discrete;
mod equilibria;
mod linearised;
mod momentum_meter;
mod phase;
mod root;
mod spectrum;

pub use discrete::{DiscreteMap, Step, StepLimit, differentiable};
pub use equilibria::{Equilibrium, EquilibriumError, relative_equilibria};
pub use linearised::{ReducedField, reduced_field};
pub use momentum_meter::MomentumMeter;
pub use phase::{Rounds, weighted_mean};
