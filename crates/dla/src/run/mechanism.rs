use super::state::AnyState;
use crate::{Checkpoint, CheckpointError, Integrator, Report, Rules, SensitivityError, StepError};
use crate::{Method, ReducedField};
use lagrangian::linear::Singular;
use lagrangian::{MotionError, PowerSources, ReducedError, Seeded};
use nalgebra::DMatrix;
use std::cell::Cell;
use std::fmt;

/// A mechanical system as runs, analyses and commands see it: numbers in slices, sizes known at run time.
///
/// [`Subject`](crate::Subject) is one for every system of a shape. Entries are whole questions, of which a run asks a few at each node; what a
/// step asks is [`Mechanics`](crate::Mechanics). A slice that is too short counts as one with values that are not numbers.
pub trait Mechanism {
    /// How many coordinates and constraints it has.
    fn size(&self) -> Size;

    /// Which coordinates are angles.
    fn angles(&self) -> Vec<bool>;

    /// A state at `q` with velocity `v`.
    fn state(&self, q: &[f64], v: &[f64]) -> AnyState;

    /// The state that [`AnyState::save`] wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has no state with this number of coordinates.
    fn load_state(&self, checkpoint: &Checkpoint) -> Result<AnyState, CheckpointError>;

    /// The method, made for this system: its own closed form or series if it has one.
    fn integrator(&self, method: &Method) -> Box<dyn Integrator + '_>;

    /// The midpoint discrete Lagrange-d'Alembert map in its general form.
    fn general_map(&self) -> Box<dyn Integrator + '_>;

    /// The times of the jumps of forces and constraints in the open interval from `from` to `to` (s), in any order.
    fn jump_times(&self, from: f64, to: f64) -> Vec<f64>;

    /// The smooth piece that holds at the time `t` (s), continued to all times.
    fn smooth_piece(&self, t: f64) -> Box<dyn Mechanism + '_>;

    /// The energy `v . L_v - L` (J).
    fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// The kinetic energy `v . L_v / 2` (J) of a Lagrangian of second degree in the velocities.
    fn kinetic_energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// The residual of every constraint, `A v + b`, or `phi` of one that is not affine.
    fn residual(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64>;

    /// The largest residual of the constraints.
    fn largest_residual(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// The largest residual of the discrete constraint of a step from `q` with the mean velocity `v`; NaN if it is not known.
    fn largest_step_residual(&self, rules: &Rules, time: (f64, f64), q: &[f64], v: &[f64]) -> f64;

    /// The largest of the functions of the constraints on positions; `None` if there are none.
    fn largest_position(&self, t: f64, state: &AnyState) -> Option<f64>;

    /// The misses of the constraints on positions, each with its gradient; zero within rounding.
    fn position_misses(&self, t: f64, q: &[f64]) -> Vec<(f64, Vec<f64>)>;

    /// If a velocity misses its constraints by more than rounding, the impulse of the constraints brings it there
    /// ([`onto_constraint`](crate::onto_constraint())). `time` is the time (s) and the length of the next steps (s).
    ///
    /// # Errors
    /// [`StepError::Newton`] if the constraints do not determine the velocity.
    fn onto_constraint(&self, time: (f64, f64), state: &mut AnyState) -> Result<(), StepError>;

    /// The error of a step from a state, with its cause if that can be named.
    fn explained(&self, time: (f64, f64), state: &AnyState, error: StepError) -> StepError;

    /// The sources that may do work on the system.
    fn power_sources(&self) -> PowerSources;

    /// The work of a step between two nodes by these sources ([`Work`](crate::Work)).
    fn work_between(&self, sources: PowerSources, from: Place<'_>, to: Place<'_>) -> f64;

    /// Accelerations and multipliers of the continuous system.
    ///
    /// # Errors
    /// [`MotionError`] if the mass matrix or the constraint is degenerate.
    fn motion(&self, t: f64, q: &[f64], v: &[f64]) -> Result<[Vec<f64>; 2], MotionError>;

    /// The velocity `W xi + v_b` of quasi-velocities.
    ///
    /// # Errors
    /// [`ReducedError`] if there is no basis, or a degenerate one.
    fn velocity_of(&self, t: f64, q: &[f64], xi: &[f64]) -> Result<Vec<f64>, ReducedError>;

    /// The quasi-velocities of a velocity, as many as there are coordinates; entries beyond the dimension of the distribution do not count.
    ///
    /// # Errors
    /// As [`velocity_of`](Self::velocity_of).
    fn quasi_velocities(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Vec<f64>, ReducedError>;

    /// The quasi-velocities that the last step left, else the quasi-velocities of the velocity.
    ///
    /// # Errors
    /// As [`velocity_of`](Self::velocity_of).
    fn quasi_velocities_of(&self, t: f64, state: &AnyState) -> Result<Vec<f64>, ReducedError>;

    /// Whether some constraint has a velocity of its own at a place: `b` is not zero.
    fn is_driven(&self, t: f64, q: &[f64]) -> bool;

    /// Shows the system with its basis for the neighbourhood of a configuration, and the number of that basis, if its bases are local
    /// ([`System::near`](lagrangian::System::near)); returns whether they are.
    fn near(&self, t: f64, q: &[f64], basis: u64, then: &mut dyn FnMut(u64, &dyn Mechanism)) -> bool;

    /// Shows the system with a count of its evaluations.
    fn counted(&self, evaluations: &Cell<u64>, then: &mut dyn FnMut(&dyn Mechanism));

    /// The reduced equations with their derivatives ([`reduced_field`](crate::reduced_field())); `None` without a basis.
    ///
    /// # Errors
    /// [`Singular`] if the equations are degenerate.
    fn reduced_field(&self, t: f64, q: &[f64], xi: &[f64]) -> Option<Result<ReducedField, Singular>>;

    /// The reduced equations on numbers with derivatives, velocities and accelerations; `None` if there are none.
    fn reduced_flow(&self, t: f64, q: &[Seeded], xi: &[Seeded]) -> Option<[Vec<Seeded>; 2]>;

    /// The velocity of quasi-velocities on numbers with derivatives.
    fn velocity_seeded(&self, t: f64, q: &[Seeded], xi: &[Seeded]) -> Option<Vec<Seeded>>;

    /// Whether the steps of a method on it have derivatives for exponents ([`has_tangents`](crate::has_tangents)).
    ///
    /// # Errors
    /// [`SensitivityError::Unsupported`] with the reason, if they have none.
    fn has_tangents(&self, method: &Method) -> Result<(), SensitivityError>;

    /// The derivative of a step of a method, in the `2 n - m` coordinates `(q, xi)`.
    ///
    /// # Errors
    /// [`SensitivityError`] if the method or the system has none.
    fn step_derivative(
        &self,
        method: &Method,
        time: (f64, f64),
        ends: [&AnyState; 2],
        report: &Report,
    ) -> Result<DMatrix<f64>, SensitivityError>;
}

/// The number of coordinates and constraints of a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Coordinates.
    pub n: usize,
    /// Constraints.
    pub m: usize,
}

/// A time (s), a configuration with its full turns, and a velocity.
pub type Place<'a> = (f64, &'a [f64], &'a [f64]);

impl fmt::Debug for dyn Mechanism + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Size { n, m } = self.size();
        write!(f, "a system of {n} coordinates and {m} constraints")
    }
}
