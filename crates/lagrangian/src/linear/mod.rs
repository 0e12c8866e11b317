//! Linear algebra of a few unknowns, on the stack.

mod lu;
mod pivots;
mod row_space;
mod rows;
mod saddle;

pub use lu::{Inverse, Lu, Singular, has_positive_determinant, larger, largest, normal_solve};
pub(crate) use lu::{dependent, dot};
pub use pivots::Pivots;
pub use row_space::{Dependence, RowSpace};
pub use rows::Rows;
pub use saddle::{Bordered, FactoredSaddle, Saddle};
