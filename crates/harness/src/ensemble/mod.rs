//! Ensembles: many starts of a system, summed up one by one, on all threads.

mod stream;
mod summary;
mod watch;

pub use stream::in_order;
pub use summary::{Quantities, Summary};
pub use watch::{Watching, summarise};
