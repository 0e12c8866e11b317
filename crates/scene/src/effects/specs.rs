use serde::Serialize;
use sleigh::effects::Hill;
use sleigh::{ClosedPath, Formula, Ramp, SleighError, Table, TimeFunction};

/// A function of time as a scene writes it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum TimeSpec {
    /// The same value at all times.
    Constant(f64),
    /// `amplitude sin(frequency t + phase)`.
    Sine {
        /// In the unit of the quantity.
        amplitude: f64,
        /// Angular frequency (rad/s).
        frequency: f64,
        /// At `t = 0` (rad).
        phase: f64,
    },
    /// Numbers at times.
    Table {
        /// Increasing (s).
        times: Vec<f64>,
        /// In the unit of the quantity.
        values: Vec<f64>,
        /// What the function is between two times.
        #[serde(skip_serializing_if = "Interpolation::is_left_out")]
        interpolation: Interpolation,
    },
    /// A formula in `t`.
    Formula(String),
}

/// What a table of times is between two of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// `values[i]` from `times[i]` on.
    #[default]
    Steps,
    /// Straight lines from point to point.
    Linear,
}

impl Interpolation {
    /// Every one, by its name in files.
    pub(crate) const NAMES: [(&str, Self); 2] = [("steps", Self::Steps), ("linear", Self::Linear)];

    fn is_left_out(&self) -> bool {
        *self == Self::default()
    }
}

impl TimeSpec {
    pub(super) fn varies(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Sine { amplitude, frequency, .. } => *amplitude != 0.0 && *frequency != 0.0,
            Self::Table { values, .. } => values.windows(2).any(|pair| pair[0].to_bits() != pair[1].to_bits()),
            Self::Formula(text) => Formula::new(text).is_ok_and(|formula| !formula.is_constant()),
        }
    }

    /// Whether the function, or its slope, jumps.
    pub(super) fn has_corners(&self) -> bool {
        match self {
            Self::Table { times, .. } => times.len() > 1,
            Self::Formula(text) => Formula::new(text).is_ok_and(|formula| formula.has_corners()),
            Self::Constant(_) | Self::Sine { .. } => false,
        }
    }

    /// The jumps of a formula up to this time (s); `None` if there are too many to find.
    pub(crate) fn jumps(&self, duration: f64) -> Option<Vec<f64>> {
        match self {
            Self::Formula(text) => {
                Formula::new(text).map_or(Some(Vec::new()), |formula| formula.corners(0.0, duration))
            }
            _ => Some(Vec::new()),
        }
    }

    /// No value of the function is larger; of a formula the one at the start.
    pub(crate) fn largest(&self) -> f64 {
        match self {
            Self::Constant(value) | Self::Sine { amplitude: value, .. } => value.abs(),
            Self::Table { values, .. } => values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs())),
            Self::Formula(text) => {
                Formula::new(text).map_or(0.0, |formula| TimeFunction::Formula(formula).value(0.0_f64).abs())
            }
        }
    }

    /// The function.
    pub(crate) fn build(&self) -> Result<TimeFunction, SleighError> {
        Ok(match self {
            Self::Constant(value) => TimeFunction::Constant(*value),
            Self::Sine { amplitude, frequency, phase } => {
                TimeFunction::Sine { amplitude: *amplitude, frequency: *frequency, phase: *phase }
            }
            Self::Table { times, values, interpolation: Interpolation::Steps } => {
                TimeFunction::Table(Table::new(times.clone(), values.clone())?)
            }
            Self::Table { times, values, interpolation: Interpolation::Linear } => {
                TimeFunction::Ramp(Ramp::new(times.clone(), values.clone())?)
            }
            Self::Formula(text) => TimeFunction::Formula(Formula::new(text)?),
        })
    }
}

/// A closed path as a scene writes it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathSpec {
    /// What is run through.
    #[serde(flatten)]
    pub shape: PathShape,
    /// Time for one round (s).
    pub period: f64,
}

/// The shape of a closed path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PathShape {
    /// A circle, counterclockwise from `center + (radius, 0)`.
    Circle {
        /// Radius (m).
        radius: f64,
        /// Middle (m).
        center: [f64; 2],
    },
    /// A polygon with these vertices (m), from the first.
    Polygon(Vec<[f64; 2]>),
}

impl PathSpec {
    /// The path.
    ///
    /// # Errors
    /// [`SleighError`] if the path cannot be followed, which cannot happen to a path read from a file.
    pub fn build(&self) -> Result<ClosedPath, SleighError> {
        match &self.shape {
            PathShape::Circle { radius, center } => ClosedPath::circle(*radius, *center, self.period),
            PathShape::Polygon(vertices) => ClosedPath::polygon(vertices.clone(), self.period),
        }
    }
}

/// A hill as a scene writes it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HillSpec {
    /// Height (J).
    pub height: f64,
    /// Middle (m).
    pub x: f64,
    /// Middle (m).
    pub y: f64,
    /// Width (m).
    pub width: f64,
}

impl From<HillSpec> for Hill {
    fn from(HillSpec { height, x, y, width }: HillSpec) -> Self {
        Self { height, x, y, width }
    }
}

/// The trailers of a scene; each list has one number for every trailer, or one for all.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrailersSpec {
    /// How many there are.
    pub count: usize,
    /// Masses (kg).
    pub mass: Vec<f64>,
    /// Moments of inertia about the centres of mass (kg m^2).
    pub inertia: Vec<f64>,
    /// Distances of the centres of mass ahead of the blades (m).
    pub offset: Vec<f64>,
    /// Distances of the hinges behind the blades before them (m).
    pub hitch: Vec<f64>,
    /// Distances of the hinges ahead of the trailers' own blades (m).
    pub bar: Vec<f64>,
    /// Headings at the start (rad). A trailer without a heading has the heading of the blade before it.
    pub headings: Vec<f64>,
}
