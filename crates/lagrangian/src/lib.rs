//! What a constrained mechanical system is.
//!
//! A [`System`] is a Lagrangian and a velocity constraint `A(q, t) v + b(q, t) = 0`, each written once as a function
//! generic in its [`Scalar`]. Everything else follows from the two: [momenta and energies](energy), the
//! [equations of motion](Motion), and the derivatives of a discrete Lagrangian by a [`Rule`]. Derivatives are exact, by [dual](Dual) [numbers](HyperDual), never by differences.
//!
//! This crate knows no integrator and no particular system.

mod equations;
mod geometry;
pub mod linear;
mod numbers;
pub mod quadrature;
pub mod simd;
mod system;

pub use equations::*;
pub use geometry::*;
pub use linear::{Bordered, Dependence, FactoredSaddle, Pivots, RowSpace, Rows, Saddle};
pub use numbers::*;
pub use quadrature::{Alpha, Midpoint, NotAWeight, Rule, RuleNode, Trapezoid};
pub use scalar::{
    Scalar, ScalarFunction, array, assigning_operators, called, from_fn, mapped, mul_add, power_of_two_below,
    sin_cos_wrapped,
};
pub use system::*;
