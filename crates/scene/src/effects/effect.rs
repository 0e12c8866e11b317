use super::specs::{HillSpec, PathSpec, TimeSpec, TrailersSpec};
use serde::Serialize;

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
    /// Drag by the square of the speed.
    QuadraticDrag { along: f64, turning: f64 },
    /// Coulomb friction, smoothed at rest.
    Friction { along: f64, smoothing: f64, turning: f64, turning_smoothing: f64 },
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

impl SceneEffect {
    /// Whether it is a function of time, and not of the state alone.
    pub(crate) fn depends_on_time(&self) -> bool {
        matches!(self, Self::Tracer { .. }) || self.functions().into_iter().any(TimeSpec::varies)
    }

    /// The functions of time in it.
    pub(crate) fn functions(&self) -> Vec<&TimeSpec> {
        match self {
            Self::Flywheel { torque, .. } => torque.iter().collect(),
            Self::Thrust { force: function } | Self::Torque { torque: function } => vec![function],
            Self::MovingMass { x, y, .. } => vec![x, y],
            Self::Servo { speed, turn_rate } => speed.iter().chain(turn_rate).collect(),
            _ => Vec::new(),
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
            Self::QuadraticDrag { .. } => "quadratic_drag",
            Self::Friction { .. } => "friction",
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
