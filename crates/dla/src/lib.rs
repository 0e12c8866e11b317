//! Discrete Lagrange-d'Alembert integrators.
//!
//! A method is a [`OneStep`] map on the constraint distribution: from a state `(q, v)` with `A(q) v + b = 0` to the next
//! one. [`Dla`] derives it from a discrete Lagrangian and a discrete constraint; [`drive`] repeats it and shows every
//! node to an [`Observer`], of which [`Trajectory`] is one that keeps what it sees.
//!
//! [`Sensitivity`] differentiates the steps of a [`Differentiable`] method.
//!
//! This crate knows no particular system and no file; its [`Newton`] solver knows neither time nor mechanics.

mod mechanics;
mod method;
mod methods;
mod run;
mod sensitivity;
mod solve;
mod step;

pub use solve::convergence;

use mechanics::{dependent, dropping, known_angle, not_a_number, power, reduced_field, start, suspect};
use methods::dla::{
    continued, corrections, derivatives, discrete_lagrangian, discretisation, increment, kept, mean, past,
};
use methods::{baseline, composition, dla, energy, gauss, gni, hermite, lobatto, rebased, reduced_flow, taylor};
use solve::{branch, history, newton, overshoot, positions, projection};
use step::{assembly_fault, closed_step_error, hint, one_step, resolved, runaway, stack, state};

pub use crate::dla::{Dla, Form};
pub use assembly_fault::{AssemblyFault, ConstraintRow, DependentRows};
pub use baseline::{Dop853, ImplicitMidpoint, Rk4, Rk4Projected, Rk4Reduced};
pub use branch::{followed, turn};
pub use closed_step_error::ClosedStepError;
pub use composition::Composition;
pub use dependent::{Dependency, Dependent};
pub use discrete_lagrangian::DiscreteLagrangian;
pub use discretisation::{Discretisation, EndMomenta, RoundedStep, Rules};
pub use dropping::on_branch;
pub use energy::Energy;
pub use gauss::{Collocation, CollocationOutcome, Gauss, GaussAdaptive};
pub use gni::Gni;
pub use hermite::Hermite;
pub use hint::Hint;
pub use history::History;
pub use known_angle::KnownAngle;
pub use lobatto::{LinearisedStage, Lobatto, LobattoTables, StagePoint};
pub use mechanics::{
    Diagnosis, FullMechanics, Mechanics, ReducedSeries, RoundedMechanics, SecondSlopes, SeededMechanics, Slopes,
};
pub use method::{METHODS, Method, MethodError, MethodInfo, MethodKind, has_derivatives, has_tangents};
pub use newton::{Equations, Newton, NewtonError};
pub use not_a_number::{Derivative, NotANumber, SystemFunction, Variable, not_a_number};
pub use one_step::{OneStep, OwnStep, Stage, StepError, StepReport};
pub use overshoot::{damping, inertia, overshoot};
pub use power::{MeanPower, power};
pub use rebased::Rebased;
pub use reduced_field::{ReducedField, reduced_field};
pub use resolved::Halved;
pub use run::{
    AnyState, AnyTangent, Checkpoint, CheckpointError, Close, Crossing, Direction, Event, Integrator, Mechanism,
    Member, Node, Nodes, Observer, OwnMethods, ParametrisedMechanics, ParametrisedMechanism, Part, Piece,
    PiecewiseMechanics, Place, RecommendError, Recommendation, Report, RunError, Samples, Schedule, SeeOwnStep,
    Shorter, Size, Stateful, Stepper, Stop, Subject, SubstepSummary, Substeps, Trajectory, Undivided, View, Watch,
    Work, Zero, Zeros, again, close_crossings, drive, drive_part, fitted, make_steps, onto_constraint, piece_by_piece,
    pieces, recommend_by_trial, row, smooth_pieces, stops, substepped_part, zeros,
};
#[cfg(feature = "shapes")]
pub use run::{CompiledShape, PARAMETERS, Shapes};
pub use runaway::Runaway;
pub use sensitivity::{
    Differentiable, ReducedDerivative, ReducedVariation, Sensitivity, SensitivityError, StepDerivative, StepEquations,
    StepStart, StepUnknowns, Tangent, TangentRunError, Variation,
};
pub use stack::StackUse;
pub use start::{Start, consistent_start, slip};
pub use state::State;
pub use taylor::Taylor;
