//! The numbers that carry a model.

mod called;
pub(crate) mod derived;
mod dual;
mod gradient;
mod hyperdual;
mod lanes;
mod octaves;
mod rounded;
mod shown;
mod traced;
mod twofold;

pub use called::{Called, SeldomNumber};
pub use dual::Dual;
pub use gradient::Gradient;
pub(crate) use gradient::by_places;
pub use hyperdual::HyperDual;
pub use lanes::{Lanes, vectorized};
pub use octaves::{octaves, of_octaves};
pub use rounded::Rounded;
pub use shown::Shown;
pub use traced::Traced;
pub use twofold::{Twofold, added, two_sum};
