use crate::{History, NewtonError, NotANumber, Stage, StepError};
use lagrangian::linear::Singular;
use std::fmt;
use thiserror::Error;

/// One constraint of an assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConstraintRow {
    /// Its element, counted from 0 in the order in which they were added.
    pub element: u32,
    /// Its row within the element, from 0.
    pub row: u32,
    /// The name that the element was added with.
    pub name: &'static str,
}

impl fmt::Display for ConstraintRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "row {} of element {} ({})", self.row, self.element, self.name)
    }
}

/// Constraints that depend on one another, the four heaviest, the heaviest first.
pub type DependentRows = [Option<ConstraintRow>; 4];

/// The error of a step of an assembly of many elements, if it tells more than the error of one system.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum AssemblyFault {
    /// The sparse matrix could not be analysed or factorised, for want of memory or by its size.
    #[error("the sparse matrix of {unknowns} unknowns cannot be factorised: {reason}")]
    Factorisation {
        /// Its size.
        unknowns: usize,
        /// What the library says.
        reason: &'static str,
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
        /// The constraints that depend on one another; empty if the constraints are independent.
        constraints: DependentRows,
    },
    /// The equations have a solution, but it cannot be shown to continue the motion.
    #[error("the step is too long: a constraint would turn by {turn:.2} rad in one step")]
    Branch {
        /// The largest turn of a constraint (rad).
        turn: f64,
    },
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
}

impl AssemblyFault {
    /// The nearest error of a step of one system.
    pub(crate) fn of_one_system(self) -> StepError {
        match self {
            Self::Factorisation { reason, .. } => StepError::Unsupported { reason },
            Self::Singular { stage, pivot, constraints } => {
                let source = Singular { column: constraints[0].map_or(0, |row| row.element as usize), pivot };
                let source = NewtonError::Singular { iteration: 1, source, history: History::new() };
                StepError::Newton { stage, source }
            }
            Self::Branch { .. } => StepError::Branch,
            Self::NotANumber { source, .. } => StepError::NotANumber(source),
        }
    }
}

fn involved(constraints: &DependentRows) -> String {
    let named: Vec<String> = constraints.iter().flatten().map(ToString::to_string).collect();
    if named.is_empty() { String::new() } else { format!("; dependent there: {}", named.join(", ")) }
}
