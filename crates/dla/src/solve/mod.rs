//! Equations and their solution: one Newton iteration, one test of convergence, and which solution continues the motion.

pub(crate) mod branch;
pub mod convergence;
pub(crate) mod history;
pub(crate) mod newton;
pub(crate) mod overshoot;
pub(crate) mod positions;
pub(crate) mod projection;
