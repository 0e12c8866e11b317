//! Discrete variational integrators for systems with velocity constraints: blades, wheels, rolling bodies.
pub use dla;
pub use lagrangian;
pub use sleigh;
