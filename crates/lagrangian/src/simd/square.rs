use crate::from_fn;

/// A square matrix of eight rows, in the order in which its product with a vector in registers takes it.
///
/// To bring one number of a register into all its places is slow, to exchange its places is not. So term `d` has, in row `i`, the
/// coefficient of the number that an exchange of places by the bits of `d` brings there, the one at `i xor d`.
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
