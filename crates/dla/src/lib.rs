//! Discrete Lagrange-d'Alembert integrators.
//!
//! A method is a [`OneStep`] map on the constraint distribution: from a state `(q, v)` with `A(q) v + b = 0` to the next
//! one. [`Dla`] derives it from a discrete Lagrangian and a discrete constraint; [`drive`] repeats it and shows every
//! node to an [`Observer`], of which [`Trajectory`] is one that keeps what it sees.
//!
//! [`Sensitivity`] differentiates the steps of a [`Differentiable`] method.
//!
//! This crate knows no particular system and no file; its [`Newton`] solver knows neither time nor mechanics.

mod branch;
mod checkpoint;
mod closed_step_error;
mod composition;
mod continued;
pub mod convergence;
mod corrections;
mod dependent;
mod derivatives;
mod discretisation;
mod divide;
mod dla;
mod drive;
mod dropping;
mod energy;
pub mod ensemble;
mod events;
mod gauss;
mod gni;
mod hermite;
mod hint;
mod history;
mod increment;
mod kept;
mod known_angle;
mod lobatto;
mod mean;
mod mechanics;
mod newton;
mod not_a_number;
mod one_step;
mod overshoot;
mod past;
mod pieces;
mod positions;
mod power;
mod projection;
mod rebased;
mod recommend;
mod resolved;
mod runaway;
mod samples;
mod sensitivity;
mod settle;
mod stack;
mod start;
mod state;
mod stop;
mod subject;
mod substepping;
mod suspect;
mod trajectory;
mod unknowns;
mod work;

pub use crate::dla::{Dla, Form};
pub use branch::{followed, turn};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use closed_step_error::ClosedStepError;
pub use composition::Composition;
pub use dependent::{Dependency, Dependent};
pub use discretisation::{Discretisation, EndMomenta, HandMade, RoundedStep, Rules};
pub use divide::{Substeps, Undivided};
pub use drive::{Observer, Part, RunError, Schedule, Shorter, View, drive, drive_part};
pub use dropping::on_branch;
pub use energy::Energy;
pub use ensemble::{Each, Ensemble, GaussEnsemble, LaneState, Same, Systems};
pub use events::{Close, Crossing, Direction, Event, Watch, Zero, Zeros, close_crossings, zeros};
pub use gauss::{Collocation, CollocationOutcome, Gauss, GaussAdaptive};
pub use gni::Gni;
pub use hermite::Hermite;
pub use hint::Hint;
pub use history::History;
pub use known_angle::KnownAngle;
pub use lobatto::{LinearisedStage, Lobatto, LobattoTables, StagePoint};
pub use mechanics::{Diagnosis, FullMechanics, Mechanics, RoundedMechanics, SecondSlopes, SeededMechanics, Slopes};
pub use newton::{Equations, Newton, NewtonError};
pub use not_a_number::{Derivative, NotANumber, SystemFunction, Variable, not_a_number};
pub use one_step::{OneStep, OwnStep, Stage, StepError, StepReport};
pub use pieces::{
    Piece, PiecewiseMechanics, fitted, onto_constraint, piece_by_piece, piece_by_piece_from, pieces, smooth_pieces,
};
pub use power::{MeanPower, power};
pub use rebased::Rebased;
pub use recommend::{RecommendError, Recommendation, recommend_by_trial, recommend_step};
pub use resolved::Halved;
pub use runaway::Runaway;
pub use samples::Samples;
pub use sensitivity::{
    Differentiable, ReducedDerivative, ReducedVariation, Sensitivity, SensitivityError, StepDerivative, StepEquations,
    StepStart, StepUnknowns, Tangent, TangentRunError, Variation,
};
pub use stack::StackUse;
pub use start::{Start, consistent_start, slip};
pub use state::State;
pub use stop::{Stop, stops};
pub use subject::{OwnMethods, Stepper, Subject};
pub use substepping::Substepping;
pub use trajectory::{Node, Nodes, Trajectory};
pub use work::Work;
