use serde::Serialize;
use sleigh::effects::Hill;
use sleigh::{ClosedPath, SleighError, Table, TimeFunction};

/// A function of time as a scene writes it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum TimeSpec {
    /// The same at all times.
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
    /// `values[i]` from `times[i]` on.
    Table {
        /// Increasing (s).
        times: Vec<f64>,
        /// In the unit of the quantity.
        values: Vec<f64>,
    },
}

impl TimeSpec {
    fn varies(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Sine { amplitude, frequency, .. } => *amplitude != 0.0 && *frequency != 0.0,
            Self::Table { values, .. } => values.windows(2).any(|pair| pair[0].to_bits() != pair[1].to_bits()),
        }
    }

    /// No value of the function is larger.
    pub(crate) fn largest(&self) -> f64 {
        match self {
            Self::Constant(value) | Self::Sine { amplitude: value, .. } => value.abs(),
            Self::Table { values, .. } => values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs())),
        }
    }

    /// The function.
    pub(crate) fn build(&self) -> Result<TimeFunction, SleighError> {
        Ok(match self {
            Self::Constant(value) => TimeFunction::Constant(*value),
            Self::Sine { amplitude, frequency, phase } => {
                TimeFunction::Sine { amplitude: *amplitude, frequency: *frequency, phase: *phase }
            }
            Self::Table { times, values } => TimeFunction::Table(Table::new(times.clone(), values.clone())?),
        })
    }
}

/// A closed path as a scene writes it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathSpec {
    /// What is run through.
    #[serde(flatten)]
    pub shape: Shape,
    /// Time for one round (s).
    pub period: f64,
}

/// The shape of a closed path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
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
    /// [`SleighError`] where it cannot be followed, which one read from a file can.
    pub fn build(&self) -> Result<ClosedPath, SleighError> {
        match &self.shape {
            Shape::Circle { radius, center } => ClosedPath::circle(*radius, *center, self.period),
            Shape::Polygon(vertices) => ClosedPath::polygon(vertices.clone(), self.period),
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
    /// Headings at the start (rad); those that are missing are that of the blade before.
    pub headings: Vec<f64>,
}

/// An effect of a scene, as its `[[effects]]` entry says it; what each means is with the type of that name in the crate
/// `sleigh`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[allow(missing_docs, reason = "the keys are those of the scene format, with their units in docs/scenes.md")]
pub enum SceneEffect {
    /// A uniform tangential gravity.
    Slope { gravity: [f64; 2] },
    /// A quadratic well.
    Bowl { stiffness: [f64; 2], center: [f64; 2] },
    /// A periodic landscape.
    EggCrate { height: f64, wave_number: [f64; 2] },
    /// Gaussian hills.
    Hills { hills: Vec<HillSpec> },
    /// A rotor on the sleigh.
    Flywheel {
        inertia: f64,
        rotor_rate: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        torque: Option<TimeSpec>,
    },
    /// Viscous drag.
    Drag { along: f64, turning: f64 },
    /// A force along the blade.
    Thrust { force: TimeSpec },
    /// A torque on the heading.
    Torque { torque: TimeSpec },
    /// A mass that is moved in the body.
    MovingMass { mass: f64, x: TimeSpec, y: TimeSpec },
    /// Imposed speed or turn rate.
    Servo {
        #[serde(skip_serializing_if = "Option::is_none")]
        speed: Option<TimeSpec>,
        #[serde(skip_serializing_if = "Option::is_none")]
        turn_rate: Option<TimeSpec>,
    },
    /// The centre of mass led along a path.
    Tracer { path: PathSpec },
    /// A turning plane.
    Turntable { rate: f64 },
    /// A train of further blades.
    Trailers(TrailersSpec),
}

/// Name, keys and meaning of every kind of effect, in the order of the documentation.
pub const EFFECTS: &[(&str, &[&str], &str)] = &[
    ("slope", &["gravity"], "uniform tangential gravity, gravity = [gx, gy] in m/s^2"),
    ("bowl", &["stiffness", "center"], "quadratic well at the centre of mass, stiffness = [kx, ky] in N/m"),
    ("egg_crate", &["height", "wave_number"], "periodic landscape V0 (cos(kx X) + cos(ky Y))"),
    ("hills", &["hills"], "Gaussian hills, each {height, x, y, width}"),
    ("flywheel", &["inertia", "rotor_rate", "torque"], "rotor on the sleigh, free or with a motor torque"),
    ("drag", &["along", "turning"], "viscous drag along the blade and against turning"),
    ("thrust", &["force"], "force along the blade, constant or a function of time"),
    ("torque", &["torque"], "torque on the heading, constant or a function of time"),
    ("moving_mass", &["mass", "x", "y"], "a mass moved in the body along a given path"),
    ("servo", &["speed", "turn_rate"], "imposed speed, turn rate or both"),
    ("tracer", &["path"], "centre of mass led along a closed path: the planimeter"),
    ("turntable", &["rate"], "a plane that turns about the origin"),
    (
        "trailers",
        &["count", "mass", "inertia", "offset", "hitch", "bar", "headings"],
        "a train of further blades, each hinged to the one before it",
    ),
];

impl SceneEffect {
    /// Whether it is a function of time, and not of the state alone.
    pub(crate) fn depends_on_time(&self) -> bool {
        let varies = |function: &Option<TimeSpec>| function.as_ref().is_some_and(TimeSpec::varies);
        match self {
            Self::Slope { .. } | Self::Bowl { .. } | Self::EggCrate { .. } | Self::Hills { .. } => false,
            Self::Drag { .. } | Self::Turntable { .. } | Self::Trailers(_) => false,
            Self::Flywheel { torque, .. } => varies(torque),
            Self::Thrust { force: function } | Self::Torque { torque: function } => function.varies(),
            Self::MovingMass { x, y, .. } => x.varies() || y.varies(),
            Self::Servo { speed, turn_rate } => varies(speed) || varies(turn_rate),
            Self::Tracer { .. } => true,
        }
    }

    /// The name of its kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Slope { .. } => "slope",
            Self::Bowl { .. } => "bowl",
            Self::EggCrate { .. } => "egg_crate",
            Self::Hills { .. } => "hills",
            Self::Flywheel { .. } => "flywheel",
            Self::Drag { .. } => "drag",
            Self::Thrust { .. } => "thrust",
            Self::Torque { .. } => "torque",
            Self::MovingMass { .. } => "moving_mass",
            Self::Servo { .. } => "servo",
            Self::Tracer { .. } => "tracer",
            Self::Turntable { .. } => "turntable",
            Self::Trailers(_) => "trailers",
        }
    }
}
