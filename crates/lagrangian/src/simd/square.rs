use std::array::from_fn;

/// A square matrix of eight rows, in the order in which its product with a vector in registers takes it.
///
/// To bring one number of a register into all its places is slow, to exchange its places is not. So term `4 k + d` has, in row
/// `i`, the coefficient of that number of the vector's half `k` which an exchange of its places by `d` brings there, the one at
/// `(i mod 4) xor d`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Square {
    /// The terms.
    pub terms: [[f64; 8]; 8],
}

impl Square {
    /// The matrix with these columns.
    #[must_use]
    pub fn of_columns(columns: &[[f64; 8]; 8]) -> Self {
        Self { terms: from_fn(|term| from_fn(|i| columns[4 * (term / 4) + ((i % 4) ^ (term % 4))][i])) }
    }
}
