//! What may act on a sleigh: each effect adds to the Lagrangian or to the forces, on the coordinates of the body.
//!
//! They compose as tuples or lists in [`lagrangian::With`], on any [`SleighBody`](crate::SleighBody).

mod bowl;
mod drag;
mod egg_crate;
mod hills;
mod moving_mass;
mod slope;
mod thrust;
mod torque;

pub use bowl::Bowl;
pub use drag::Drag;
pub use egg_crate::EggCrate;
pub use hills::{Hill, Hills};
pub use moving_mass::MovingMass;
pub use slope::Slope;
pub use thrust::Thrust;
pub use torque::Torque;

use crate::SleighError;
use lagrangian::Piecewise;

/// Effects that no jump cuts.
macro_rules! smooth {
    ($($effect:ty),+) => {
        $(impl Piecewise for $effect {
            fn piece(&self, _t: f64) -> Self {
                self.clone()
            }
        })+
    };
}
smooth!(Bowl, Drag, EggCrate, Hills, Slope);

/// The numbers, where all are finite.
fn finite<const K: usize>(quantity: &'static str, numbers: [f64; K]) -> Result<[f64; K], SleighError> {
    match numbers.iter().find(|x| !x.is_finite()) {
        Some(value) => Err(SleighError::NotFinite { quantity, value: *value }),
        None => Ok(numbers),
    }
}

/// The number, where it is finite and positive.
fn positive(quantity: &'static str, value: f64) -> Result<f64, SleighError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(SleighError::NotPositive { quantity, value }) }
}

/// The number, where it is finite and not negative.
fn not_negative(quantity: &'static str, value: f64) -> Result<f64, SleighError> {
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(SleighError::Negative { quantity, value }) }
}
