use dla::{History, NewtonError, NotANumber, Stage, StepError};
use lagrangian::Shown;
use lagrangian::linear::Singular;
use std::fmt;
use thiserror::Error;

/// One constraint of an assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConstraintRow {
    /// Its element, counted from 0 in the order in which they were added.
    pub element: usize,
    /// The name that the element was added with.
    pub name: &'static str,
    /// Its row within the element, from 0.
    pub row: usize,
}

impl fmt::Display for ConstraintRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "row {} of element {} ({})", self.row, self.element, self.name)
    }
}

/// Why an assembly could not be made, or a step of it failed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AssemblyError {
    /// An element names a coordinate that is not there, or one twice.
    #[error("the {name} is placed on coordinate {coordinate}, which does not exist or is named twice")]
    Coordinates {
        /// The element's name.
        name: &'static str,
        /// The coordinate.
        coordinate: usize,
    },
    /// An element has too many coordinates.
    #[error("the {name} has {coordinates} coordinates; an element has at most {}", crate::WIDEST)]
    Wide {
        /// The element's name.
        name: &'static str,
        /// How many.
        coordinates: usize,
    },
    /// A number of a model is not what it must be.
    #[error("{what} must be {accepted}, and is {value}")]
    Number {
        /// Which.
        what: &'static str,
        /// What it may be.
        accepted: &'static str,
        /// What it is.
        value: f64,
    },
    /// The sparse matrix could not be analysed or factorised, for want of memory or by its size.
    #[error("the sparse matrix of {unknowns} unknowns cannot be factorised: {reason}")]
    Factorisation {
        /// Its size.
        unknowns: usize,
        /// What the library says.
        reason: String,
    },
    /// The matrix of a step does not determine its solution.
    #[error(
        "{stage}: the matrix is singular to round-off (pivot {pivot:e}, relative to its \
        column){}",
        involved(constraints)
    )]
    Singular {
        /// In which equations.
        stage: Stage,
        /// The smallest pivot, relative to its column; zero if none is left.
        pivot: f64,
        /// The constraints that depend on one another, the heaviest first; empty if the constraints are independent.
        constraints: Vec<ConstraintRow>,
    },
    /// Newton's method found no solution.
    #[error("{stage}: {source}")]
    Newton {
        /// On which equations.
        stage: Stage,
        /// How.
        #[source]
        source: NewtonError,
    },
    /// The equations have a solution, but it cannot be shown to continue the motion.
    #[error("the step is too long: a constraint would turn by {turn:.2} rad in one step")]
    Branch {
        /// The largest turn of a constraint (rad).
        turn: f64,
    },
    /// Forces that depend on the velocity are too stiff for the step.
    #[error("the step is too long: the braking forces would reverse the velocity; a step {} times shorter resolves them", Shown(part.recip()))]
    Overshoot {
        /// The longest fraction of the step at which they do not reverse a velocity.
        part: f64,
    },
    /// A coordinate or a velocity became infinite or NaN.
    #[error("the coordinates or the velocities are no longer finite")]
    NotFinite,
    /// A function of an element, or one of its derivatives, is infinite or NaN; coordinates and rows are numbered as in the assembly.
    #[error("element {element} ({name}): {source}")]
    NotANumber {
        /// The element, counted from 0 in the order in which they were added.
        element: usize,
        /// The name that the element was added with.
        name: &'static str,
        /// Which function.
        #[source]
        source: NotANumber,
    },
    /// The method makes the step, but its halves lead elsewhere (see [`dla::Halved`]); asked only of steps that may be made in parts.
    #[error("the step does not resolve the motion: two steps of half the length end elsewhere")]
    Unresolved,
    /// The caller has asked for the end ([`dla::Stop`]).
    #[error("ended before it was done")]
    Stopped,
    /// Forces or constraints jump inside the step, where no method has an order.
    #[error("forces or constraints jump at t = {} s, inside the step: the run has fewer steps than pieces between jumps", Shown(*time))]
    Jump {
        /// The time of the jump (s).
        time: f64,
    },
    /// The method cannot do assemblies.
    #[error("{reason}")]
    Unsupported {
        /// The reason.
        reason: &'static str,
    },
}

impl AssemblyError {
    /// Whether shorter steps may succeed: see [`StepError::may_hold_in_parts`]. Dependent constraints stay dependent in any step.
    #[must_use]
    pub fn may_hold_in_parts(&self) -> bool {
        match self {
            Self::Singular { constraints, .. } if !constraints.is_empty() => false,
            error => error.step_error().may_hold_in_parts(),
        }
    }

    /// The nearest error of a static step. It does not name the singular constraints.
    #[must_use]
    pub fn step_error(&self) -> StepError {
        match self {
            Self::Newton { stage, source } => StepError::Newton { stage: *stage, source: *source },
            Self::Singular { stage, pivot, constraints } => {
                let column = constraints.first().map_or(0, |row| row.element);
                let source = Singular { column, pivot: *pivot };
                let source = NewtonError::Singular { iteration: 1, source, history: History::new() };
                StepError::Newton { stage: *stage, source }
            }
            Self::Branch { .. } => StepError::Branch,
            Self::Overshoot { part } => StepError::Overshoot { part: *part },
            Self::NotFinite => StepError::NotFinite,
            Self::NotANumber { source, .. } => StepError::NotANumber(*source),
            Self::Unresolved => StepError::Unresolved,
            Self::Stopped => StepError::Stopped,
            Self::Jump { time } => StepError::Jump { time: *time },
            Self::Unsupported { reason } => StepError::Unsupported { reason },
            Self::Coordinates { .. } | Self::Wide { .. } | Self::Number { .. } | Self::Factorisation { .. } => {
                StepError::Unsupported { reason: "the assembly could not be made" }
            }
        }
    }
}

fn involved(constraints: &[ConstraintRow]) -> String {
    let named: Vec<String> = constraints.iter().map(ToString::to_string).collect();
    if named.is_empty() { String::new() } else { format!("; dependent there: {}", named.join(", ")) }
}

/// A run that ended early. The state is then the state of the last good node.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("step {step}, from t = {} s: {source}", Shown(*time))]
pub struct AssemblyRunError {
    /// The number of the failed step, from 1.
    pub step: u64,
    /// The time at which the failed step began, up to which the trajectory is valid (s).
    pub time: f64,
    /// The error of the step.
    #[source]
    pub source: AssemblyError,
}
