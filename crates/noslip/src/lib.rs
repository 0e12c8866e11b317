//! Discrete variational integrators for systems with velocity constraints: blades, wheels, rolling bodies.
//!
//! This crate gathers what a program needs under one name; each thing is documented where it is defined.
//!
//! | to | see |
//! |---|---|
//! | describe a system: its Lagrangian and its constraint | [`System`], [`Scalar`] |
//! | say what its constraints are, and start on them | [`classify`], [`consistent_start`] |
//! | give a body an attitude that ends nowhere; refuse steps near where other coordinates end | [`Attitude`], [`InChart`] |
//! | add what acts on a body | [`Effect`], [`With`] |
//! | ask what its constraints let it reach, and what its symmetries conserve | [`lagrangian::growth`], [`lagrangian::conservation`] |
//! | choose a method | [`Dla`], [`DiscreteLagrangian`], [`OneStep`] |
//! | run it and look on | [`drive`], [`Schedule`], [`State`], [`Observer`], [`Trajectory`] |
//! | differentiate its steps in state, parameters and controls | [`Sensitivity`], [`Parametrised`], [`Member`] |
//! | find events, take samples, stop and resume, choose a step | [`Event`], [`Watch`], [`Samples`], [`Checkpoint`], [`recommend_step`] |
//! | use the Chaplygin sleigh, its closed form and its own integrator | [`Sleigh`], [`SleighState`], [`Exact`], [`ClosedMap`] |
//! | assemble many bodies (the cargo feature `assembly`) | the crate `noslip-assembly`, here `noslip::assembly` |

#[cfg(feature = "assembly")]
pub use assembly;
pub use dla::{
    self, Checkpoint, CheckpointError, ClosedStepError, Crossing, Direction, Dla, Equations, Event, Form, Hermite,
    Hint, History, InChart, Mechanics, Newton, NewtonError, Node, NotANumber, Observer, OneStep, RecommendError,
    Recommendation, RunError, Samples, Schedule, Sensitivity, Stage, State, StepError, StepReport, Trajectory, View,
    Watch, consistent_start, drive, recommend_step,
};
pub use lagrangian::{
    self, AdmissibleBasis, Alpha, Attitude, Constraint, Derivatives, DiscreteConstraint, DiscreteLagrangian, Dual,
    Effect, Function, HyperDual, Lanes, Member, Midpoint, Motion, MotionError, Parametrised, Reduced, Rule, Scalar,
    Symmetrised, System, Trapezoid, With, classify, constraint_residual, energy, mass_matrix, momentum, vectorized,
};
pub use sleigh::{self, CentreOfMass, ClosedMap, Exact, Sleigh, SleighError, SleighState};

/// The examples of the README and of the book, compiled and run as tests.
#[cfg(doctest)]
mod book {
    #[doc = include_str!("../../../README.md")]
    pub struct Readme;
    #[doc = include_str!("../../../docs/guide/first-simulation.md")]
    pub struct FirstSimulation;
    #[doc = include_str!("../../../docs/guide/your-own-system.md")]
    pub struct YourOwnSystem;
    #[doc = include_str!("../../../docs/guide/many-bodies.md")]
    pub struct ManyBodies;
    #[doc = include_str!("../../../docs/phenomena/naive.md")]
    pub struct Naive;
    #[doc = include_str!("../../../docs/phenomena/parking.md")]
    pub struct Parking;
    #[doc = include_str!("../../../docs/phenomena/flywheel.md")]
    pub struct Flywheel;
    #[doc = include_str!("../../../docs/sensitivities.md")]
    pub struct Sensitivities;
}
