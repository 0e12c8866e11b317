use crate::{AssemblyFault, ClosedStepError, Dependent, Mechanics, NewtonError, NotANumber, State};
use lagrangian::Shown;
use lagrangian::{MotionError, PowerSources, ReducedError};
use std::ops::ControlFlow;
use thiserror::Error;

/// A one-step map on the constraint distribution: `(q, v)` with `A(q) v + b = 0` to the next such pair.
pub trait OneStep<const N: usize, const M: usize> {
    /// Moves `state` from time `t` to `t + h`.
    ///
    /// # Errors
    /// [`StepError`] if the step has no solution that the method accepts; `state` is then unchanged.
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError>;

    /// As [`step`](Self::step), and shows the ends of the steps that the method makes of its own within it, all but the last. A `Break`
    /// ends the step there; then the time (s) of that end is returned, otherwise `None`.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    fn step_until(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        state: &mut State<N>,
        _see: &mut OwnStep<'_, N>,
    ) -> Result<(StepReport<M>, Option<f64>), StepError> {
        Ok((self.step(system, t, h, state)?, None))
    }

    /// The memory of the method besides the state, for a checkpoint; empty if the next step depends on the state alone.
    fn memory(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Restores the memory that [`memory`](Self::memory) gave when the run was at `state`.
    fn recall(&mut self, _memory: &[f64], _state: &State<N>) {}

    /// Forgets all that depends on the system: the next step is one of another system, or in another basis.
    fn forget(&mut self, state: &State<N>) {
        self.recall(&[], state);
    }

    /// Asks for the work that these sources do in the steps to come, in [`StepReport::work`]. A method of high order, or with steps of its
    /// own, integrates the power as it does the motion; no observer can with its accuracy. Other methods report none: their order is not
    /// above the order of [`Work`](crate::Work).
    fn measure_work(&mut self, _sources: PowerSources) {}

    /// Shows the time (s) and the state at the ends of the steps that the method makes of its own within a step from `t` to `t + h`: all
    /// but the last, which ends with the step; `Break` asks for no more of them. A method without steps of its own shows nothing.
    ///
    /// It serves observers that look inside steps, as [`Watch`](crate::Watch) does. The step is made once more, so that a step without such
    /// an observer costs nothing. `memory` holds the [memory](Self::memory) of the method before the step, and then after it; it is empty
    /// before the first step, and has no meaning after a `Break`.
    ///
    /// # Errors
    /// As [`step`](Self::step), after what was shown until then.
    fn own_steps(
        &self,
        _system: &dyn Mechanics<N, M>,
        (_t, _h): (f64, f64),
        _state: &State<N>,
        _memory: &mut Vec<f64>,
        _see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        Ok(())
    }
}

/// A method behind a pointer is that method.
macro_rules! behind {
    ($pointer:ty) => {
        impl<Method: OneStep<N, M> + ?Sized, const N: usize, const M: usize> OneStep<N, M> for $pointer {
            fn step(
                &mut self,
                system: &dyn Mechanics<N, M>,
                t: f64,
                h: f64,
                state: &mut State<N>,
            ) -> Result<StepReport<M>, StepError> {
                (**self).step(system, t, h, state)
            }

            fn step_until(
                &mut self,
                system: &dyn Mechanics<N, M>,
                step: (f64, f64),
                state: &mut State<N>,
                see: &mut OwnStep<'_, N>,
            ) -> Result<(StepReport<M>, Option<f64>), StepError> {
                (**self).step_until(system, step, state, see)
            }

            fn memory(&self) -> Vec<f64> {
                (**self).memory()
            }

            fn recall(&mut self, memory: &[f64], state: &State<N>) {
                (**self).recall(memory, state);
            }

            fn forget(&mut self, state: &State<N>) {
                (**self).forget(state);
            }

            fn measure_work(&mut self, sources: PowerSources) {
                (**self).measure_work(sources);
            }

            fn own_steps(
                &self,
                system: &dyn Mechanics<N, M>,
                step: (f64, f64),
                state: &State<N>,
                memory: &mut Vec<f64>,
                see: &mut OwnStep<'_, N>,
            ) -> Result<(), StepError> {
                (**self).own_steps(system, step, state, memory, see)
            }
        }
    };
}

behind!(Box<Method>);
behind!(&mut Method);

/// Looks at the end of a step that a method makes of its own, a time (s) and a state.
pub type OwnStep<'a, const N: usize> = dyn FnMut(f64, &State<N>) -> ControlFlow<()> + 'a;

/// The report of a step, besides the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport<const M: usize> {
    /// Impulses of the constraints at the two ends of the step (N s); the constraint acts with `A(q0)' impulses[0] + A(q1)' impulses[1]`.
    /// Zero if a method does not compute them.
    pub impulses: [[f64; M]; 2],
    /// Newton iterations of the step's equations; 0 for an explicit method.
    pub iterations: u32,
    /// The work done over the step (J), by a method whose energy balance knows it, or that was [asked](OneStep::measure_work) to integrate
    /// it.
    pub work: Option<f64>,
    /// Round-off that the equations of the step leave in its velocities, in their units; zero if the last digits settle.
    pub rounding: f64,
}

impl<const M: usize> StepReport<M> {
    /// The report of a step that reports only its iterations.
    #[must_use]
    #[inline(always)]
    pub fn of(iterations: u32) -> Self {
        Self { impulses: [[0.0; M]; 2], iterations, work: None, rounding: 0.0 }
    }

    /// The sum of the reports of this step and the next.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let sum = |end: usize| lagrangian::from_fn(|k| self.impulses[end][k] + next.impulses[end][k]);
        let work = match (self.work, next.work) {
            (Some(before), Some(work)) => Some(before + work),
            (before, work) => before.or(work),
        };
        let (iterations, rounding) = (self.iterations + next.iterations, self.rounding.max(next.rounding));
        Self { impulses: [sum(0), sum(1)], iterations, work, rounding }
    }

    /// The constraint forces, averaged over a step of length `h`: second-order accurate in its middle.
    #[must_use]
    pub fn multipliers(&self, h: f64) -> [f64; M] {
        lagrangian::from_fn(|k| (self.impulses[0][k] + self.impulses[1][k]) / h)
    }
}

/// Which equations of a step failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The discrete Lagrange-d'Alembert equations, for the increment.
    Increment,
    /// The stages of a collocation method.
    Collocation,
    /// The projection of the momentum onto the constraint, for the new velocity.
    Projection,
    /// The projection of a configuration onto the constraints on positions.
    Positions,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Increment => "the discrete Lagrange-d'Alembert equations",
            Self::Collocation => "the stages of the collocation",
            Self::Projection => "the projection onto the constraint",
            Self::Positions => "the projection onto the constraints on positions",
        })
    }
}

/// Why a step failed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum StepError {
    /// Newton's method, or the fixed-point iteration in its place, failed.
    #[error("{stage}: {source}")]
    Newton {
        /// The equations that failed.
        stage: Stage,
        /// How they failed.
        #[source]
        source: NewtonError,
    },
    /// The closed form of the step failed.
    #[error("closed form of the step: {0}")]
    Closed(#[source] ClosedStepError),
    /// The continuous equations of motion do not determine the accelerations.
    #[error(transparent)]
    Motion(MotionError),
    /// The reduced equations, in quasi-velocities, do not exist.
    #[error(transparent)]
    Reduced(#[from] ReducedError),
    /// Rows of the constraint depend on one another.
    #[error(transparent)]
    Dependent(#[from] Dependent),
    /// The velocity at the start of a run is not admissible.
    #[error(
        "the start does not obey constraint {}: its residual is {}; `consistent_start` gives the nearest state that does", row + 1, Shown(*residual)
    )]
    Slips {
        /// The row, from zero.
        row: usize,
        /// The residual of the row.
        residual: f64,
    },
    /// A function of the system, or a derivative of one, is not a number or not finite.
    #[error(transparent)]
    NotANumber(#[from] NotANumber),
    /// The force on a coordinate jumps at the velocity zero, and the system comes to rest there: beyond there is no motion, however short
    /// the step.
    #[error(
        "the force on coordinate {coordinate} jumps where the velocity changes its direction, as `sign(v)` does, and the motion comes to \
        rest there: no step is short enough; write a smooth function of the velocity, as `tanh(v/eps)` with a small speed `eps`, or end the \
        run before"
    )]
    JumpsAtRest {
        /// The coordinate.
        coordinate: usize,
    },
    /// The method cannot do this system.
    #[error("{reason}")]
    Unsupported {
        /// The reason.
        reason: &'static str,
    },
    /// The system has more coordinates and constraints than the method has room for on the stack; no step was begun.
    #[error(
        "a system of {coordinates} coordinates and {constraints} constraints is too large for this method: a step needs \
         {bytes} bytes of the stack; the limit is {limit} bytes"
    )]
    TooLarge {
        /// `N`.
        coordinates: usize,
        /// `M`.
        constraints: usize,
        /// The stack that the step would take, as [`StackUse`](crate::StackUse) counts it (bytes).
        bytes: usize,
        /// The limit (bytes).
        limit: usize,
    },
    /// The step of an energy-preserving method changes the energy by more than the work of the forces.
    #[error(
        "the energy would change by {defect:.2e} J more than the work of the forces, and round-off explains only \
            {bound:.2e} J: the step is too long for the quadrature of the energy"
    )]
    Energy {
        /// The change (J).
        defect: f64,
        /// The change that rounding explains (J).
        bound: f64,
    },
    /// Forces or constraints jump inside the step; no method has its order across a jump.
    #[error("forces or constraints jump at t = {} s, inside the step: the run has fewer steps than pieces between jumps", Shown(*time))]
    Jump {
        /// The time of the jump (s).
        time: f64,
    },
    /// The equations of the step have a solution, but it belongs to another motion, or cannot be shown to continue this one.
    #[error("Newton's method converged to a solution on another branch than that of the motion")]
    Branch,
    /// The equations of the step are linear, and their only solution is not near the velocity at its beginning: forces that change with the
    /// place are too stiff for the step.
    #[error(
        "the step is too long: forces that change with the place change the velocity by more than the method follows in it"
    )]
    Stiff,
    /// The velocity at the beginning would turn the constraint by half a turn or more in the step, which its rule cannot tell from a
    /// smaller turn the other way round.
    #[error(
        "the step is too long: coordinate {} would turn by {} rad in it, and the method tells turns below pi rad, those of {} s", coordinate + 1,
        Shown(*turn), Shown(*step * std::f64::consts::PI / *turn)
    )]
    Turn {
        /// The coordinate that turns most, from zero.
        coordinate: usize,
        /// The angle by which the constraint would turn (rad).
        turn: f64,
        /// The length of the step, or of the part of one that a composition makes (s).
        step: f64,
    },
    /// The mass matrix is singular or nearly so, and the method needs it.
    #[error(
        "the mass matrix is singular or nearly so (a pivot is {pivot:.0e} of its row and column), and the stages of this method then leave a \
         velocity open; where the constraints determine the motion, `dla`, `gauss` and `energy` do not need it"
    )]
    LightMass {
        /// The smallest pivot, relative to its row and column.
        pivot: f64,
    },
    /// The basis of admissible velocities that was derived for the neighbourhood of a configuration does not hold along the step.
    #[error(
        "the step is too long: bodies turn so far in it that no derived basis of the admissible velocities holds along it; a basis given by hand \
         may hold everywhere"
    )]
    LeavesBasis,
    /// Forces that depend on the velocity are too stiff for the step: they would drive the velocity past the value at which they vanish.
    #[error("the step is too long: the braking forces would reverse the velocity; a step {} times shorter resolves them", Shown(part.recip()))]
    Overshoot {
        /// The longest part of the step in which they do not.
        part: f64,
    },
    /// An adaptive method does not meet its tolerance within a step.
    #[error("the method does not meet the tolerance: after {tries} inner steps the next inner step would have {} \
        s", Shown(*step))]
    Tolerance {
        /// The steps tried, refused ones included.
        tries: u32,
        /// The length of the next one (s).
        step: f64,
    },
    /// A coordinate or a velocity became infinite or not a number.
    #[error("the coordinates or the velocities are no longer finite")]
    NotFinite,
    /// The method makes the step, but its two halves lead elsewhere, or its velocities do not account for its way (see
    /// [`Halved`](crate::Halved)); asked only of steps that may be made in parts.
    #[error("the step does not resolve the motion: two steps of half the length end elsewhere")]
    Unresolved,
    /// The caller has asked for the end ([`Stop`](crate::Stop)); no run fails by that, it ends before the step.
    #[error("ended before it was done")]
    Stopped,
    /// The step of an assembly of many elements failed.
    #[error(transparent)]
    Assembly(#[from] AssemblyFault),
}

impl StepError {
    /// The error of a state that is one of another system.
    pub const OTHER_SHAPE: Self =
        Self::Unsupported { reason: "the state is one of a system with another number of coordinates" };

    /// Whether equations did not determine their solution.
    pub(crate) fn is_singular(&self) -> bool {
        matches!(
            self,
            Self::Newton { source: NewtonError::Singular { .. }, .. }
                | Self::Motion(_)
                | Self::Reduced(ReducedError::Motion(_))
        )
    }
}
