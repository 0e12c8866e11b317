//! Ensembles: many starts of a system, summed up one by one, in lanes where there are lanes for it, on all threads.
//!
//! ```
//! use dla::{LaneState, Mechanics, Schedule};
//! use harness::ensemble::{Watching, watch};
//! use sleigh::{ClosedEnsemble, Sleigh, SleighState};
//!
//! let sleighs = [Sleigh::new(1.0, 1.0, 0.5)?; 16];
//! let starts: Vec<_> = (0..16).map(|i| ([0.0; 3], [-1.0, 0.1 + 0.01 * f64::from(i), 0.0])).collect();
//! let state = LaneState::new(&starts, [false, false, true]);
//! let mut ensemble = ClosedEnsemble::new(sleighs, 0.05, state);
//! let schedule = Schedule { t0: 0.0, step: 0.05, steps: 800 };
//! let speed = |_: f64, q: &[f64; 3], v: &[f64; 3]| [SleighState::from_coordinates(q, v).speed];
//! let systems = sleighs.each_ref().map(|sleigh| sleigh as &dyn Mechanics<3, 1>);
//! let summaries = watch(&mut ensemble, &systems, &Watching { schedule, every: 50, of: &speed });
//! assert!(summaries.iter().flatten().all(|summary| summary.low[0] < -0.9 && summary.end[0] > 1.0));
//! # Ok::<(), sleigh::SleighError>(())
//! ```

mod stream;
mod summary;
mod watch;

pub use stream::in_order;
pub use summary::{Quantities, Summary};
pub use watch::{Watching, summarise, watch};
