//! The geometry of the constraints.

mod classify;
mod growth;

pub use classify::{
    Classification, RowKind, classify, rank_is_constant, redundant_rows, row_space, rows_are_consistent,
};
pub use growth::{Growth, GrowthError, growth};
