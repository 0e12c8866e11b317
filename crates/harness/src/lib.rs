//! The comparison harness: baselines, long-run drift, and work against precision.
//!
//! [`Method`] names every integrator; [`run`] makes one run of it and measures it as a [`Record`];
//! [`precision::work_precision`] measures what accuracy costs in time; [`analysis`] asks whether a motion is chaotic.

pub mod analysis;
mod cost;
mod drift;
pub mod ensemble;
pub mod precision;
mod record;
mod run;
mod saved;
mod sensitivities;
mod slip;
pub mod stability;
mod statistics;
mod stopwatch;
mod timing;
mod watched;

pub use cost::{step_evaluations, step_time};
pub use dla::{METHODS, Method, MethodError, MethodInfo, MethodKind, SubstepSummary};
pub use drift::{Blocks, Drift, DriftVerdict, Energies, EnergyJump};
pub use record::{EnergySummary, NewtonSummary, Record, Sample};
pub use run::{Request, integrate_from, integrate_on, integrate_pieces, run, timed};
pub use saved::{SavedCrossing, SavedRun, Saving, run_saved, run_saved_watched};
pub use sensitivities::{Moving, SensitivitiesError, differentiated, sensitivities};
pub use statistics::Trend;
pub use timing::Progress;
pub use watched::{EVENT_SAMPLES, Watched, recommend, run_observed, run_watched};
