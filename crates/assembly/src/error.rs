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
        /// The smallest pivot, relative to its column; zero where none is left.
        pivot: f64,
        /// The constraints that depend on one another there, the heaviest first; none where it is not they.
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
        /// By how much the constraint turns that turns most (rad).
        turn: f64,
    },
    /// Forces that depend on the velocity are too stiff for the step.
    #[error("the step is too long: the braking forces would reverse the velocity; a step {} times shorter resolves them", Shown(part.recip()))]
    Overshoot {
        /// The longest part of the step for which they do not.
        part: f64,
    },
    /// A coordinate or a velocity became infinite or not a number.
    #[error("the coordinates or the velocities are no longer finite")]
    NotFinite,
    /// A function of an element, or a derivative of one, is not a number or not finite; coordinates and rows are those of the assembly.
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
    /// Whoever waits has asked for the end ([`dla::Stop`]).
    #[error("ended before it was done")]
    Stopped,
    /// Forces or constraints jump inside the step, across which no method has an order.
    #[error("forces or constraints jump at t = {} s, inside the step: the run has fewer steps than pieces between jumps", Shown(*time))]
    Jump {
        /// When (s).
        time: f64,
    },
    /// The method cannot do assemblies.
    #[error("{reason}")]
    Unsupported {
        /// Why not.
        reason: &'static str,
    },
}

impl AssemblyError {
    /// Whether shorter steps may do what this one has not: see [`StepError::may_hold_in_parts`]. Constraints that depend on one another
    /// do so in any step.
    #[must_use]
    pub fn may_hold_in_parts(&self) -> bool {
        match self {
            Self::Singular { constraints, .. } if !constraints.is_empty() => false,
            error => error.step_error().may_hold_in_parts(),
        }
    }

    /// The error of a static step that says most of it; which constraints are singular it does not know.
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

/// A run that ended early; the state is that of the last good node.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("step {step}, from t = {} s: {source}", Shown(*time))]
pub struct AssemblyRunError {
    /// The number of the failed step, from 1.
    pub step: u64,
    /// The time it began at, which is how far the trajectory is valid (s).
    pub time: f64,
    /// What happened.
    #[source]
    pub source: AssemblyError,
}
