//! Ensembles: many starts of a system, each summed up in a few numbers, in order and on all threads.

mod stream;
mod summary;

pub use stream::in_order;
pub use summary::{Summary, summarise};
