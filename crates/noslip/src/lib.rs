//! Discrete variational integrators for systems with velocity constraints: blades, wheels, rolling bodies.
//!
//! This crate gathers what a program needs under one name; each thing is documented where it is defined.
//!
//! | to | see |
//! |---|---|
//! | describe a system: its Lagrangian and its constraint | [`System`], [`Scalar`] |
//! | say what its constraints are, and start on them | [`classify`], [`consistent_start`] |
//! | add what acts on a body; derive a basis of the admissible velocities | [`Effect`], [`With`]; [`WithBasis`] |
//! | ask what its constraints let it reach | [`lagrangian::growth`] |
//! | choose a method | [`Dla`], [`DiscreteLagrangian`], [`OneStep`] |
//! | run it and look on | [`drive`], [`Schedule`], [`State`], [`Observer`], [`Trajectory`]; by any method, [`Subject`] |
//! | differentiate its steps in state, parameters and controls | [`Sensitivity`], [`Parametrised`], [`Member`] |
//! | find events, take samples, stop and resume, choose a step | [`Event`], [`Watch`], [`Samples`], [`Checkpoint`], [`dla::recommend_by_trial`] |
//! | use the Chaplygin sleigh, its closed form and its own integrator | [`Sleigh`], [`SleighState`], [`Exact`], [`ClosedMap`] |
//! | compare methods by long runs, and by time against error (the cargo feature `compare`) | `noslip::compare`, `noslip::precision` |
//! | write a trajectory for NumPy (the cargo feature `npz`) | `noslip::write_npz` |
//! | assemble many bodies (the cargo feature `assembly`) | the crate `noslip-assembly`, here `noslip::assembly` |

#[cfg(feature = "compare")]
mod compare;
#[cfg(feature = "npz")]
mod npz;

#[cfg(feature = "compare")]
pub use compare::{Comparison, PrecisionError, WorkPrecision, compare, precision};
#[cfg(feature = "compare")]
pub use harness;
#[cfg(feature = "npz")]
pub use npz::write_npz;

#[cfg(feature = "assembly")]
pub use assembly;
pub use dla::{
    self, Checkpoint, CheckpointError, ClosedStepError, Crossing, Direction, DiscreteLagrangian, Dla, Equations, Event,
    Form, Hermite, Hint, History, Mechanics, Mechanism, Newton, NewtonError, Node, NotANumber, Observer, OneStep,
    RecommendError, Recommendation, RunError, Samples, Schedule, Sensitivity, Stage, State, StepError, StepReport,
    Subject, Trajectory, View, Watch, consistent_start, slip,
};
pub use lagrangian::{
    self, AdmissibleBasis, Alpha, Constraint, Dual, Effect, HyperDual, Lanes, Member, Midpoint, Motion, MotionError,
    Parametrised, Reduced, Rule, Scalar, ScalarFunction, System, Trapezoid, With, WithBasis, classify,
    constraint_residual, energy, mass_matrix, momentum, vectorized,
};
pub use sleigh::{self, CentreOfMass, ClosedMap, Exact, Sleigh, SleighError, SleighState};

#[doc(hidden)]
pub use macros;

/// A system from its texts, at compile time.
///
/// The keys and texts are as in `[system]` of a scene file (the book, *Scene files*), after the name of a structure. Its fields are the
/// parameters, and [`Default`] gives them their values in the text. It is a [`System`] with simplified formulas, on any [`Scalar`]. If a
/// basis of the admissible velocities is given or found, its [reduced equations](Reduced) are derived too; otherwise [`WithBasis`]
/// derives a basis at run time. Each of the `outputs` is a function of time, coordinates and rates. A wrong text is a compiler error at
/// its place.
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

/// Makes the steps of a schedule from a start that obeys the constraints, and shows every node to the observer. Returns the number of steps
/// made. [`dla::drive`] accepts any start: its first step leads from a start that slips onto the constraint.
///
/// # Errors
/// [`StepError::Slips`] with the residual, if the start does not obey the constraints to six digits: [`consistent_start`] gives the nearest
/// state that does. [`RunError`] names the step that failed; `state` is then the last good node.
pub fn drive<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &mut dyn OneStep<N, M>,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: impl Observer,
) -> Result<u64, RunError> {
    match slip(system, schedule.t0, state) {
        Some(source) => Err(RunError::new(1, schedule.t0, source)),
        None => dla::drive(system, method, schedule, state, observer),
    }
}

/// The imports of a program with a system of its own: `use noslip::prelude::*`.
pub mod prelude {
    pub use crate::{
        AdmissibleBasis, Constraint, Dla, OneStep, Reduced, Scalar, Schedule, State, System, Trajectory, WithBasis,
        consistent_start, drive, method, system,
    };
    pub use lagrangian::Piecewise;
}

/// A method by its name in the table of methods: `noslip::method!("gauss16")`. Only the methods that a program names are compiled for its
/// system. Each method replaces the basis of a [`WithBasis`] at nodes at which it becomes bad. An unknown name is a compiler error.
///
/// ```
/// use noslip::prelude::*;
///
/// # struct Free;
/// # impl System<1, 0> for Free {
/// #     fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
/// #         v[0] * v[0] * 0.5
/// #     }
/// #     fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 0> {
/// #         ([], [])
/// #     }
/// # }
/// let mut state = State::new([0.0], [2.0], [false]);
/// drive(&Free, &mut method!("dla4"), &Schedule { t0: 0.0, step: 0.1, steps: 10 }, &mut state, ())?;
/// assert!((state.q()[0] - 2.0).abs() < 1e-14);
/// # Ok::<(), noslip::RunError>(())
/// ```
///
/// ```compile_fail
/// let method = noslip::method!("gauss17");
/// ```
#[macro_export]
macro_rules! method {
    ("dla") => {
        $crate::dla::Rebased::new($crate::Dla::midpoint())
    };
    ("dla-trapezoid") => {
        $crate::dla::Rebased::new($crate::Dla::new($crate::Trapezoid, $crate::Trapezoid))
    };
    ("dla4") => {
        $crate::dla::Rebased::new($crate::dla::Composition::suzuki4($crate::Dla::midpoint()))
    };
    ("dla6") => {
        $crate::dla::Rebased::new($crate::dla::Composition::kahan_li6($crate::Dla::midpoint()))
    };
    ("dla8") => {
        $crate::dla::Rebased::new($crate::dla::Composition::fifteen8($crate::Dla::midpoint()))
    };
    ("lobatto3") => {
        $crate::dla::Rebased::new($crate::dla::Lobatto::<3>::new())
    };
    ("lobatto4") => {
        $crate::dla::Rebased::new($crate::dla::Lobatto::<4>::new())
    };
    ("lobatto5") => {
        $crate::dla::Rebased::new($crate::dla::Lobatto::<5>::new())
    };
    ("gauss4") => {
        $crate::dla::Rebased::new($crate::dla::Gauss::new::<2>())
    };
    ("gauss6") => {
        $crate::dla::Rebased::new($crate::dla::Gauss::new::<3>())
    };
    ("gauss8") => {
        $crate::dla::Rebased::new($crate::dla::Gauss::new::<4>())
    };
    ("gauss10") => {
        $crate::dla::Rebased::new($crate::dla::Gauss::new::<5>())
    };
    ("gauss12") => {
        $crate::dla::Rebased::new($crate::dla::Gauss::new::<6>())
    };
    ("gauss14") => {
        $crate::dla::Rebased::new($crate::dla::Gauss::new::<7>())
    };
    ("gauss16") => {
        $crate::dla::Rebased::new($crate::dla::Gauss::new::<8>())
    };
    ("energy2") => {
        $crate::dla::Rebased::new($crate::dla::Energy::new::<1>())
    };
    ("energy4") => {
        $crate::dla::Rebased::new($crate::dla::Energy::new::<2>())
    };
    ("energy6") => {
        $crate::dla::Rebased::new($crate::dla::Energy::new::<3>())
    };
    ("energy8") => {
        $crate::dla::Rebased::new($crate::dla::Energy::new::<4>())
    };
    ("gni") => {
        $crate::dla::Gni::default()
    };
    ($other:literal) => {
        compile_error!(concat!(
            "no method of the library is called `",
            $other,
            "`; the baselines are in the crate `harness`"
        ))
    };
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
    pub struct FlywheelPage;
    #[doc = include_str!("../../../docs/sensitivities.md")]
    pub struct SensitivitiesPage;
}
