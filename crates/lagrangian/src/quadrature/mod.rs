//! Quadrature rules on `[0, 1]`, computed to rounding.

mod gauss;
mod rule;

pub use gauss::{gauss_collocation, gauss_legendre, gauss_legendre_twofold, lagrange, shifted_legendre};
pub use rule::{Alpha, Midpoint, NotAWeight, Rule, RuleNode, Trapezoid};
