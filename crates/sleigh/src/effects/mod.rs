//! What may act on a sleigh: each effect adds to the Lagrangian or to the forces, on the coordinates of the body.
//!
//! They compose as tuples or lists in [`lagrangian::With`], on any [`SleighBody`](crate::SleighBody).

mod bowl;
mod drag;
mod egg_crate;
mod friction;
mod hills;
mod moving_mass;
mod quadratic_drag;
mod slope;
mod thrust;
mod torque;

pub use bowl::Bowl;
pub use drag::Drag;
pub use egg_crate::EggCrate;
pub use friction::Friction;
pub use hills::{Hill, Hills};
pub use moving_mass::MovingMass;
pub use quadratic_drag::QuadraticDrag;
pub use slope::Slope;
pub use thrust::Thrust;
pub use torque::Torque;

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
smooth!(Bowl, Drag, EggCrate, Friction, Hills, QuadraticDrag, Slope);
