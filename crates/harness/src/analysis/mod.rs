//! Analyses of motions: what is steady, and how stable; what a loop leaves behind; what a symmetry conserves; whether a motion is
//! regular or chaotic, and what the flow does to areas.
//!
//! Exponents, sections and areas are those on the distribution, in the `2 N - M` coordinates `(q, xi)` of configuration and
//! quasi-velocities, where the one-step maps live. What is special to a system, such as the density of its invariant measure,
//! is handed in.

mod discrete;
mod equilibria;
mod flow;
mod linear_map;
mod linearised;
mod lyapunov;
mod manifold;
mod measure;
mod momentum_meter;
mod neutral;
mod pace;
mod parallel;
mod phase;
mod returns;
mod root;
mod search;
mod section;
mod shape;
mod spectrum;
mod stages;
mod stretch;
mod tangent;
mod verdict;
mod volume;

pub use discrete::{DiscreteMap, MapError, Step, StepLimit, differentiable};
pub use equilibria::{
    Equilibrium, EquilibriumError, RelativeEquilibria, relative_equilibria, relative_equilibria_within,
};
pub use linearised::{ReducedField, reduced_field};
pub use lyapunov::{Lyapunov, LyapunovError, LyapunovRequest, kaplan_yorke, lyapunov, lyapunov_within};
pub use measure::{enclosed_area, measure_defect};
pub use momentum_meter::MomentumMeter;
pub(crate) use parallel::STACK;
pub use parallel::{in_parallel, prepare_threads};
pub use phase::{Rounds, weighted_mean};
pub use section::{Section, section};
pub use stretch::{LyapunovFailure, Running};
pub use tangent::has_tangents;
pub use verdict::{Evidence, MotionVerdict, PARTS, Undecided};
