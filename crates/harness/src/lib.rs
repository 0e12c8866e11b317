//! The comparison harness: baselines, long-run drift, and work against precision.
//!
//! [`Method`] names every integrator; [`run`] makes one run of it and measures it as a [`Record`];
//! [`precision::work_precision`] measures what accuracy costs in time; [`analysis`] asks whether a motion is chaotic.

mod again;
pub mod analysis;
mod assembled;
mod baseline;
mod cost;
mod counted;
mod drift;
pub mod ensemble;
mod method;
pub mod precision;
mod record;
mod run;
mod saved;
mod sensitivities;
mod shapes;
mod slip;
pub mod stability;
mod statistics;
mod stepper;
mod stopwatch;
mod substeps;
mod timing;
mod watched;

pub use again::Again;
pub use assembled::{
    Assembled, AssemblyCrossing, AssemblyEvent, AssemblyNode, AssemblyNodes, assembly_end, assembly_method,
    recommend_assembly, run_assembly, run_assembly_saved, run_assembly_watched, sample_assembly,
};
pub use baseline::{Dop853, ImplicitMidpoint, Rk4, Rk4Projected, Rk4Reduced};
pub use cost::{step_evaluations, step_time};
pub use drift::{Blocks, Drift, DriftVerdict, Energies, EnergyJump};
pub use method::{METHODS, Method, MethodError, MethodInfo, MethodKind};
pub use record::{EnergySummary, NewtonSummary, Record, Sample};
pub use run::{Request, integrate, integrate_from, integrate_on, integrate_pieces, run, timed};
pub use saved::{SavedCrossing, SavedRun, Saving, run_saved, run_saved_watched};
pub use sensitivities::{Moving, ParametrisedMechanics, SensitivitiesError, differentiated, sensitivities};
pub use shapes::shapes;
pub use statistics::Trend;
pub use substeps::SubstepSummary;
pub use timing::Progress;
pub use watched::{EVENT_SAMPLES, Watched, recommend, run_observed, run_watched};
