use crate::{
    AssemblyFault, ClosedStepError, Derivative, History, NewtonError, NotANumber, RunError, Shorter, Stage, StepError,
};
use lagrangian::ReducedError;
use lagrangian::Shown;
use lagrangian::linear::Singular;
use std::fmt;

/// What to change after a failure, as far as the failure tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hint {
    /// Make the step shorter, to this part of it or less.
    ShorterStep {
        /// The part.
        part: f64,
    },
    /// Shorter steps fail as well, down to this part of the step.
    NoShorterStep {
        /// The part.
        part: f64,
    },
    /// The iteration still converged quickly when it was cut off: allow more iterations.
    MoreIterations,
    /// The iteration moves by round-off only: ask for fewer digits.
    LooserTolerance,
    /// The constraints or the mass matrix determine no velocity, at any step: look for rows that say the same.
    Constraints,
    /// The method cannot do the system.
    OtherMethod,
    /// The method has no room for so large a system: other methods take less, and an assembly keeps many bodies on the heap.
    LessStack,
    /// Choose a step that has a node at the jump of the forces.
    NodeAt {
        /// The time of the jump (s).
        time: f64,
    },
    /// The motion comes to a corner or a pole of a function: write it with functions that have a derivative there.
    Corner,
    /// A number is too large, infinite or undefined: look at the start and the parameters, then at the step.
    Numbers,
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ShorterStep { part } => write!(f, "shorten the step to {} of its length or less", Shown(*part)),
            Self::NoShorterStep { part } => write!(
                f,
                "steps of {} of its length fail as well: the motion may end there, or a formula may have a corner or a pole",
                Shown(*part)
            ),
            Self::MoreIterations => f.write_str("the iteration was still converging: allow more iterations"),
            Self::LooserTolerance => f.write_str("the iteration moves by round-off only: ask for fewer digits"),
            Self::Constraints => f.write_str(
                "the constraints and the mass matrix do not determine the velocity: look for dependent constraint rows",
            ),
            Self::OtherMethod => f.write_str("choose another method"),
            Self::LessStack => f.write_str(
                "choose a method that needs less of the stack, such as `dla` or `rk4`, or assemble the system of its bodies",
            ),
            Self::NodeAt { time } => write!(f, "choose a shorter step, so that the jump at t = {} s can be a node", Shown(*time)),
            Self::Corner => f.write_str(
                "write the function so that it has a derivative there: the root of a sum of squares (in Rust `Scalar::length`), `abs`, \
                 `min`, `max`, a power of at least 1 (of at least 2 in the Lagrangian)",
            ),
            Self::Numbers => f.write_str(
                "a number is too large or undefined: look at the start and the parameters, then at the step",
            ),
        }
    }
}

/// Half the step, if the error does not tell how much is too much.
const HALF: Hint = Hint::ShorterStep { part: 0.5 };

impl NewtonError {
    /// The corrections before the failure, relative to the largest component there was; empty if the first correction failed.
    #[must_use]
    pub fn history(&self) -> History {
        match self {
            Self::Singular { history, .. }
            | Self::Diverged { history, .. }
            | Self::IterationLimit { history, .. }
            | Self::NotFinite { history, .. } => *history,
        }
    }

    /// The iterations begun, the one that failed among them.
    #[must_use]
    pub fn iterations(&self) -> u32 {
        match self {
            Self::Singular { iteration, .. } | Self::Diverged { iteration, .. } | Self::NotFinite { iteration, .. } => {
                *iteration
            }
            Self::IterationLimit { iterations, .. } => *iterations,
        }
    }

    /// What to change. Quadratic convergence shrinks a correction to less than a quarter; corrections that do not shrink
    /// and are small are rounding.
    fn hint(&self, stage: Stage) -> Hint {
        let history = self.history();
        match self {
            // A pivot that is NaN says nothing of the rows.
            Self::Singular { source, .. } if is_overflow(source) => Hint::Numbers,
            // This matrix does not depend on the step.
            Self::Singular { .. } if stage == Stage::Projection => Hint::Constraints,
            // A fixed-point iteration that is slow is so for the step.
            Self::IterationLimit { .. } if stage == Stage::Collocation => HALF,
            Self::IterationLimit { correction, .. } => match history.last_ratio() {
                Some(ratio) if ratio < 0.25 => Hint::MoreIterations,
                Some(_) if correction.abs() < ROUNDING => Hint::LooserTolerance,
                None => Hint::MoreIterations,
                _ => HALF,
            },
            Self::NotFinite { iteration: 1, .. } => Hint::Numbers,
            _ => HALF,
        }
    }
}

/// Whether a matrix is singular only because its entries have left the range of numbers.
fn is_overflow(source: &Singular) -> bool {
    !source.pivot.is_finite()
}

/// Below this part of the largest component, corrections that do not shrink are taken for rounding.
const ROUNDING: f64 = 1e-8;

impl StepError {
    /// The corrections before the failure; `None` if nothing was iterated.
    #[must_use]
    pub fn history(&self) -> Option<History> {
        match self {
            Self::Newton { source, .. } => Some(source.history()),
            Self::Assembly(fault) => fault.of_one_system().history(),
            _ => None,
        }
    }

    /// The iterations of the failed equations; `None` if nothing was iterated.
    #[must_use]
    pub fn iterations(&self) -> Option<u32> {
        match self {
            Self::Newton { source, .. } => Some(source.iterations()),
            Self::Closed(ClosedStepError::IterationLimit { iterations, .. }) => Some(*iterations),
            Self::Assembly(fault) => fault.of_one_system().iterations(),
            _ => None,
        }
    }

    /// Whether shorter steps may succeed: this one was too long, or its iteration did not converge.
    ///
    /// Numbers that are not finite count only if an iteration has left their range; if a state has, shorter steps do not help.
    #[must_use]
    pub fn may_hold_in_parts(&self) -> bool {
        use NewtonError::{Diverged, IterationLimit, NotFinite, Singular};
        let long = matches!(self.hint(), Some(Hint::ShorterStep { .. }));
        match self {
            Self::Newton { source: Diverged { .. } | IterationLimit { .. } | NotFinite { .. }, .. } => true,
            Self::Newton { stage, source: Singular { source, .. } } => {
                long || (is_overflow(source) && *stage != Stage::Projection)
            }
            Self::Closed(_) => true,
            // Constraints that depend on one another do so in any step.
            Self::Assembly(AssemblyFault::Singular { constraints: [Some(_), ..], .. }) => false,
            Self::Assembly(fault) => fault.of_one_system().may_hold_in_parts(),
            _ => long,
        }
    }

    /// What to change; `None` if the error says no more than that it failed.
    #[must_use]
    pub fn hint(&self) -> Option<Hint> {
        Some(match self {
            Self::Newton { stage, source } => source.hint(*stage),
            // The quantity grows at least as fast as the step; but it belongs to an iterate, which may be far off.
            Self::Closed(ClosedStepError::NoSolution { value, bound, .. }) if value.is_finite() && *value >= *bound => {
                Hint::ShorterStep { part: f64::max(0.5 * bound / value, 0.25) }
            }
            Self::Closed(ClosedStepError::NotFinite { .. }) | Self::NotFinite => Hint::Numbers,
            // At the beginning of the step, a shorter step does not help.
            Self::NotANumber(NotANumber { at_node: false, .. }) => HALF,
            Self::NotANumber(NotANumber { derivative: Derivative::Value, .. }) => Hint::Numbers,
            Self::NotANumber(_) => Hint::Corner,
            Self::Turn { turn, .. } => Hint::ShorterStep { part: 0.99 * std::f64::consts::PI / turn },
            Self::Overshoot { part } => Hint::ShorterStep { part: *part },
            Self::Closed(_)
            | Self::Branch
            | Self::Stiff
            | Self::LeavesBasis
            | Self::Energy { .. }
            | Self::Tolerance { .. }
            | Self::Unresolved => HALF,
            Self::Unsupported { .. } | Self::LightMass { .. } | Self::Reduced(ReducedError::NoBasis) => {
                Hint::OtherMethod
            }
            Self::TooLarge { .. } => Hint::LessStack,
            Self::Jump { time } => Hint::NodeAt { time: *time },
            Self::Motion(error) | Self::Reduced(ReducedError::Motion(error)) if is_overflow(&error.source) => {
                Hint::Numbers
            }
            Self::Motion(_) | Self::Dependent(_) | Self::Reduced(ReducedError::Motion(_)) => Hint::Constraints,
            Self::Assembly(fault) => return fault.of_one_system().hint(),
            // It says itself what to do, or nothing is to be done.
            Self::Slips { .. } | Self::JumpsAtRest { .. } | Self::Stopped => return None,
        })
    }
}

impl RunError {
    /// The steps made before the failure: nodes `0 ..= valid_steps` are the valid part of the trajectory.
    #[must_use]
    pub fn valid_steps(&self) -> u64 {
        self.step.saturating_sub(1)
    }

    /// What to change; `None` if the error says no more than that it failed.
    #[must_use]
    pub fn hint(&self) -> Option<Hint> {
        let hint = self.source.hint();
        match (hint, self.shorter) {
            (Some(Hint::ShorterStep { .. }), Shorter::Succeeds(part)) => Some(Hint::ShorterStep { part }),
            (Some(Hint::ShorterStep { .. }), Shorter::Fails(part)) => Some(Hint::NoShorterStep { part }),
            _ => hint,
        }
    }
}
