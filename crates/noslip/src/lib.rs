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

#[doc(hidden)]
pub use macros;

/// A system from its texts, at compile time.
///
/// The keys and the texts are those of `[system]` in a scene file (the book, *Scene files*), with a structure before them. Its fields are
/// the parameters, and their values in the text its [`Default`]. It is a [`System`] whose formulas are simplified, on any [`Scalar`]; where
/// a basis of the admissible velocities is given, or can be seen, its [reduced equations](Reduced) are derived too. Each of the `outputs`
/// is a function of time, coordinates and rates. A wrong text is an error of the compiler at its place.
///
/// ```
/// use noslip::{Dla, Schedule, State, System, drive};
///
/// noslip::system! {
///     /// A skate on a slope.
///     struct Skate;
///     coordinates = { x = "m", y = "m", theta = "angle" }
///     parameters = { m = 1.0, J = 0.5, g = 1.0 }
///     lagrangian = "m/2*(x'^2 + y'^2) + J/2*theta'^2 + m*g*x"
///     constraints = ["y'*cos(theta) - x'*sin(theta)"]
///     outputs = { speed = "x'*cos(theta) + y'*sin(theta)" }
/// }
///
/// let skate = Skate { m: 2.0, ..Skate::default() };
/// let mut state = State::new([0.0; 3], [0.0, 0.0, 1.0], skate.angles());
/// drive(&skate, &mut Dla::midpoint(), &Schedule { t0: 0.0, step: 0.01, steps: 2000 }, &mut state, ())?;
/// assert!((skate.speed(20.0, state.q(), state.v()) - 20.0_f64.sin()).abs() < 1e-3);
/// # Ok::<(), noslip::RunError>(())
/// ```
///
/// A structure of your own becomes such a system by `impl Name;` in place of `struct Name;`. The values of the parameters are then Rust:
/// `parameters = { m = self.mass }`.
#[macro_export]
macro_rules! system {
    ($($text:tt)*) => { $crate::macros::system! { $crate::lagrangian; $($text)* } };
}

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
