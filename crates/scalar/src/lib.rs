//! What a number must do to carry a model, and the plain number that does: [`Scalar`], and `f64`.
//!
//! Numbers with derivatives, and many at once in vector registers, are in the crate `lagrangian`. A program that works on formulas
//! only, as the macro `system!` does while it compiles, needs no more than this.

mod functions;
mod inlined;
#[cfg(feature = "num-dual")]
mod num_dual;
mod scalar;
pub mod sincos;

pub use functions::ScalarFunction;
pub use inlined::{array, called, from_fn, mapped};
pub use scalar::{Scalar, exponential, mul_add, power_of_two_below};
pub use sincos::sin_cos_wrapped;
