use crate::from_fn;

/// A square matrix of eight rows, in the order in which its product with a vector in registers takes it.
///
/// To broadcast one lane of a register is slow, to permute its lanes is not. So term `d` has, in row `i`, the coefficient of the number
/// that the permutation by the bits of `d` brings there, the one at `i xor d`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Square {
    /// The terms.
    pub terms: [[f64; 8]; 8],
}

impl Square {
    /// The matrix with these columns.
    #[must_use]
    pub fn of_columns(columns: &[[f64; 8]; 8]) -> Self {
        Self { terms: from_fn(|term| from_fn(|i| columns[i ^ term][i])) }
    }
}
