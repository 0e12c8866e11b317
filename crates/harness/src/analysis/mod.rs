//! Whether a motion is regular or chaotic, and what the flow does to areas: Lyapunov exponents, Poincare sections, maps of
//! stability over many starts, invariant measures.
//!
//! All of it works on the distribution, in the `2 N - M` coordinates `(q, xi)` of configuration and quasi-velocities, where
//! the one-step maps live. What is special to a system, such as the density of its invariant measure, is handed in.

mod flow;
mod lyapunov;
mod measure;
mod parallel;
mod section;
mod stages;
mod stretch;
mod tangent;

pub use lyapunov::{
    Lyapunov, LyapunovError, LyapunovFailure, LyapunovRequest, Running, kaplan_yorke, lyapunov, lyapunov_by,
};
pub use measure::{enclosed_area, measure_defect};
pub use parallel::in_parallel;
pub use section::{Section, section};
pub use tangent::has_tangents;
