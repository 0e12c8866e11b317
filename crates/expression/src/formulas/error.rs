use std::fmt;
use thiserror::Error;

/// Which text of a system, by its number in its list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Entry {
    /// The system as a whole.
    System,
    /// A coordinate.
    Coordinate(usize),
    /// A parameter.
    Parameter(usize),
    /// An abbreviation.
    Abbreviation(usize),
    /// The Lagrangian.
    Lagrangian,
    /// A constraint on velocities.
    Constraint(usize),
    /// A constraint on positions.
    Position(usize),
    /// A force.
    Force(usize),
    /// The basis as a whole.
    Basis,
    /// A vector of the basis.
    Vector(usize),
    /// A component of a vector of the basis.
    Component(usize, usize),
    /// An output.
    Output(usize),
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::System => f.write_str("the system"),
            Self::Coordinate(k) => write!(f, "coordinate {}", k + 1),
            Self::Parameter(k) => write!(f, "parameter {}", k + 1),
            Self::Abbreviation(k) => write!(f, "abbreviation {}", k + 1),
            Self::Lagrangian => f.write_str("the Lagrangian"),
            Self::Constraint(k) => write!(f, "constraint {}", k + 1),
            Self::Position(k) => write!(f, "constraint {} on positions", k + 1),
            Self::Force(k) => write!(f, "force {}", k + 1),
            Self::Basis => f.write_str("the basis"),
            Self::Vector(k) => write!(f, "vector {} of the basis", k + 1),
            Self::Component(k, i) => write!(f, "component {} of vector {} of the basis", i + 1, k + 1),
            Self::Output(k) => write!(f, "output {}", k + 1),
        }
    }
}

/// What is wrong with a system of texts.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{entry}: {problem}")]
pub struct TextError {
    /// In which text.
    pub entry: Entry,
    /// What.
    pub problem: Problem,
}

impl TextError {
    /// The column of the text, counted in characters from one, where one column is at fault.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        match &self.problem {
            Problem::Expression(error) => error.column(),
            Problem::Jump { column } | Problem::RateOf { column, .. } => Some(*column),
            _ => None,
        }
    }
}

/// What is wrong with one text.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Problem {
    /// It is no expression, or uses a name that is not known there.
    #[error(transparent)]
    Expression(#[from] crate::Error),
    /// A function that jumps stands where derivatives are taken.
    #[error(
        "`sign`, `step`, `if`, `floor` and `mod` jump, and are accepted only in forces, in outputs and in abbreviations for them (column {column}); \
        `max(0, x)^2` begins at zero without a jump"
    )]
    Jump {
        /// Where.
        column: usize,
    },
    /// The rate of an abbreviation that has none.
    #[error(
        "`{name}'` is not known: the abbreviation `{name}` {} (column {column})",
        if *jumps { "jumps" } else { "contains rates, and its rate would contain accelerations" }
    )]
    RateOf {
        /// Where.
        column: usize,
        /// The abbreviation.
        name: String,
        /// Whether it jumps; else it contains rates.
        jumps: bool,
    },
    /// A constraint whose derivative in a rate contains rates.
    #[error("the constraint is not affine in the rates: the factor of `{rate}` contains `{other}`")]
    NotAffine {
        /// The rate in which it was derived.
        rate: String,
        /// A rate in that derivative.
        other: String,
    },
    /// A constraint on velocities without any.
    #[error("the constraint contains no rate; a constraint on positions belongs in `positions`")]
    NoRate,
    /// A constraint on positions without any.
    #[error("the constraint on positions contains no coordinate")]
    NoCoordinate,
    /// A Lagrangian in which a coordinate has no inertia, and too few constraints that could say how it moves.
    #[error(
        "the Lagrangian does not contain the rate `{rate}`, and the constraints do not determine it, so the acceleration of its \
        coordinate is not determined"
    )]
    NoInertia {
        /// The rate.
        rate: String,
    },
    /// A formula that is another after a turn of an angle.
    #[error(
        "the formula is not the same when the angle `{angle}` grows by a whole turn, 2 pi, as a coordinate of the unit \
        `angle` asks for: use `{angle}` in sines and cosines only, or give it the unit `rad`, which counts turns"
    )]
    NoPeriod {
        /// The angle.
        angle: String,
    },
    /// No coordinates.
    #[error("a system has at least one coordinate")]
    NoCoordinates,
    /// More constraints than coordinates.
    #[error("there are more constraints ({constraints}) than coordinates ({coordinates})")]
    TooManyConstraints {
        /// How many coordinates there are.
        coordinates: usize,
        /// How many constraints.
        constraints: usize,
    },
    /// A force on something that is no coordinate.
    #[error("`{name}` is not a coordinate, and a force acts on a coordinate; the coordinates are {known}")]
    NoSuchCoordinate {
        /// The name.
        name: String,
        /// The coordinates.
        known: String,
    },
    /// A coordinate under the name of a rate, or of time.
    #[error("`{name}` cannot be a coordinate: `t` is time, and `x'` or `x_dot` is the rate of `x`")]
    NotACoordinate {
        /// The name.
        name: String,
    },
    /// A name that a column has already.
    #[error("`{name}` names another column already")]
    Column {
        /// The name.
        name: String,
    },
    /// A name or a unit that a line of a file cannot hold.
    #[error(
        "{name:?} cannot stand in the head of a file: it is empty, has a comma, a quotation mark or a control character, or begins as a \
        formula of a spreadsheet does, with `=`, `+`, `-` or `@`"
    )]
    NotAColumn {
        /// The name.
        name: String,
    },
    /// A parameter that is not finite.
    #[error("a parameter must be a finite number, and is {value}")]
    NotFinite {
        /// Its value.
        value: f64,
    },
    /// A basis of the wrong number of vectors.
    #[error("a basis needs {expected} vectors (coordinates less constraints), and {found} are given")]
    Vectors {
        /// How many there are to be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// A vector of the wrong number of components.
    #[error(
        "a vector of the basis has a component for each of the {expected} coordinates, and this vector has \
        {found}"
    )]
    Components {
        /// How many there are to be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
}
