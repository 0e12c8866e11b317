//! Runs: the loop over steps, its pieces, and what looks on. Sizes are known at run time.

mod checkpoint;
#[cfg(feature = "shapes")]
mod compiled;
mod counted;
mod divide;
mod drive;
mod events;
mod integrator;
mod mechanism;
mod parametrised;
mod pieces;
mod recommend;
mod samples;
mod state;
mod stop;
mod subject;
mod substeps;
mod trajectory;
mod work;

pub use checkpoint::{Checkpoint, CheckpointError};
#[cfg(feature = "shapes")]
pub use compiled::{CompiledShape, PARAMETERS, Shapes};
pub use divide::{Substeps, Undivided};
pub use drive::{Observer, Part, RunError, Schedule, Shorter, View, drive, drive_part, make_steps};
pub use events::{Close, Crossing, Direction, Event, Watch, Zero, Zeros, close_crossings, zeros};
pub use integrator::{Integrator, Report, SeeOwnStep};
pub use mechanism::{Mechanism, Place, Size};
pub use parametrised::{AnyTangent, Member, ParametrisedMechanics, ParametrisedMechanism};
pub use pieces::{Piece, PiecewiseMechanics, fitted, onto_constraint, piece_by_piece, pieces, smooth_pieces};
pub use recommend::{RecommendError, Recommendation, recommend_by_trial};
pub use samples::Samples;
pub use state::{AnyState, Stateful, row};
pub use stop::{Stop, stops};
pub use subject::{OwnMethods, Stepper, Subject};
pub use substeps::{SubstepSummary, again, substepped_part};
pub use trajectory::{Node, Nodes, Trajectory};
pub use work::Work;
