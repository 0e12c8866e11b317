//! Analyses of motions: steady motions and their stability; the displacement that a loop leaves; the quantities that a symmetry conserves;
//! whether a motion is regular or chaotic, and how the flow changes areas.
//!
//! Exponents, sections and areas are computed on the distribution, in the `2 N - M` coordinates `(q, xi)` of configuration and
//! quasi-velocities, on which the one-step maps act. The caller hands in data special to a system, such as the density of its invariant
//! measure.

mod discrete;
mod equilibria;
mod flow;
mod linear_map;
mod lyapunov;
mod manifold;
mod pace;
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

pub use crate::ensemble::{in_parallel, prepare_threads};
pub use discrete::{DiscreteMap, MapError, StepLimit, has_map};
pub use equilibria::{Equilibrium, EquilibriumError, RelativeEquilibria, relative_equilibria};
pub use lyapunov::{Lyapunov, LyapunovError, LyapunovRequest, kaplan_yorke, lyapunov};
pub use phase::{Rounds, weighted_mean};
pub use section::{Section, enclosed_area, measure_defect, section};
pub use stretch::{LyapunovFailure, Running};
pub use verdict::{Evidence, MotionVerdict, PARTS, Undecided};
