//! The comparison harness: baselines, long-run drift, and work against precision.
//!
//! [`Method`] names every integrator; a [`Run`] makes its steps, or measures them as a [`Record`];
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

pub use cost::{step_evaluations, step_time};
pub use dla::{METHODS, Method, MethodError, MethodInfo, MethodKind, SubstepSummary};
pub use drift::{Blocks, Drift, DriftVerdict, Energies, EnergyJump};
pub use record::{EnergySummary, NewtonSummary, Record, Sample};
pub use run::{EVENT_SAMPLES, Made, Request, Run};
pub use saved::{SavedCrossing, Saving};
pub use sensitivities::{Moving, SensitivitiesError, differentiated, sensitivities};
pub use statistics::Trend;
pub use timing::Progress;
