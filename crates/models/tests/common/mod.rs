//! Random parameters and admissible states.

use models::Model;
use proptest::prelude::*;

/// Parameters that are not one.
pub(crate) fn parameters() -> impl Strategy<Value = [f64; 5]> {
    proptest::array::uniform5(0.3..2.5f64)
}

/// Numbers between -1 and 1 to make states from.
pub(crate) type Draws = [f64; 16];

pub(crate) fn draws() -> impl Strategy<Value = Draws> {
    proptest::array::uniform16(-1.0..1.0f64)
}

/// An admissible state, away from the singularities of the coordinates.
pub(crate) fn state<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    draws: &Draws,
) -> ([f64; N], [f64; N]) {
    // Shrunk until the coordinates are regular there, as they are at the origin.
    let mut range = 3.0;
    let mut q: [f64; N] = std::array::from_fn(|i| range * draws[i]);
    while model.regularity(&q) < 0.25 {
        range *= 0.75;
        q = std::array::from_fn(|i| range * draws[i]);
    }
    let xi = std::array::from_fn(|i| 1.5 * draws[8 + i]);
    model.admissible(q, xi)
}
