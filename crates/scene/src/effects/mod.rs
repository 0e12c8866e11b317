//! The entries of `[[effects]]`.

mod company;
mod table;
mod trailers;

pub use table::{EFFECTS, EffectInfo};
pub use trailers::TrailersSpec;

use crate::error::SceneError;
use crate::fault::Fault;
use crate::keys::abridged;
use crate::suggest;
use crate::systems::Rotor;
use crate::table::TomlTable;
use serde::Serialize;
use sleigh::effects::{AnyEffect, MovingMass};
use sleigh::{ClosedPath, Sleigh, TimeFunction};
use toml::de::DeValue;

/// An effect of a scene, by the entry of `[[effects]]` that says it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum SceneEffect {
    /// A rotor on the sleigh.
    Flywheel(Rotor),
    /// A mass that is moved in the body.
    MovingMass(MovingMass),
    /// Imposed velocities.
    Servo {
        /// The speed (m/s).
        #[serde(skip_serializing_if = "Option::is_none")]
        speed: Option<TimeFunction>,
        /// The turn rate (rad/s).
        #[serde(skip_serializing_if = "Option::is_none")]
        turn_rate: Option<TimeFunction>,
    },
    /// The centre of mass led along a path.
    Tracer {
        /// The path.
        path: ClosedPath,
    },
    /// A turning plane.
    Turntable {
        /// Its rate (rad/s).
        rate: f64,
    },
    /// A train of further blades.
    Trailers(TrailersSpec),
    /// What acts on the existing coordinates, by a potential or a force.
    #[serde(untagged)]
    Acting(AnyEffect),
}

impl SceneEffect {
    /// Whether it is a function of time, and not of the state alone.
    pub(crate) fn depends_on_time(&self) -> bool {
        matches!(self, Self::Tracer { .. }) || self.functions().into_iter().any(TimeFunction::varies)
    }

    /// The functions of time in it.
    pub(crate) fn functions(&self) -> Vec<&TimeFunction> {
        match self {
            Self::Flywheel(rotor) => rotor.torque.iter().collect(),
            Self::Acting(AnyEffect::Thrust(thrust)) => vec![&thrust.force],
            Self::Acting(AnyEffect::Torque(torque)) => vec![&torque.torque],
            Self::MovingMass(mass) => vec![&mass.x, &mass.y],
            Self::Servo { speed, turn_rate } => speed.iter().chain(turn_rate).collect(),
            _ => Vec::new(),
        }
    }

    /// The name of its kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Acting(effect) => effect.kind(),
            Self::Flywheel(_) => "flywheel",
            Self::MovingMass(_) => "moving_mass",
            Self::Servo { .. } => "servo",
            Self::Tracer { .. } => "tracer",
            Self::Turntable { .. } => "turntable",
            Self::Trailers(_) => "trailers",
        }
    }
}

/// Reads the entries of `[[effects]]`.
pub(crate) fn read(root: &TomlTable<'_>, sleigh: &Sleigh) -> Result<Vec<SceneEffect>, SceneError> {
    let mut effects: Vec<SceneEffect> = Vec::new();
    for entry in root.entries_of("effects", "a list of tables, each headed `[[effects]]`")? {
        let info = info_of(&entry)?;
        let known: Vec<&str> = ["kind"].into_iter().chain(info.keys.iter().copied()).collect();
        let path = entry.path_of(info.name);
        let table = entry.named(path).with_known_keys(&known)?;
        let effect = (info.read)(&table)?;
        company::check_company(&table, (info, &effect), &effects, sleigh.offset())?;
        company::check_energy(&table, &effect, sleigh)?;
        effects.push(effect);
    }
    Ok(effects)
}

/// The row of [`EFFECTS`] that the entry's `kind` names.
fn info_of(entry: &TomlTable<'_>) -> Result<&'static EffectInfo, SceneError> {
    let names: Vec<&str> = EFFECTS.iter().map(|info| info.name).collect();
    let accepted = || format!("one of {}", suggest::list(&names));
    let kind = entry.get("kind").ok_or_else(|| entry.missing("kind", accepted()))?;
    let DeValue::String(name) = kind.get_ref() else {
        return Err(entry.wrong_type("kind", kind, accepted()));
    };
    EFFECTS.iter().find(|info| info.name == name).ok_or_else(|| {
        let fault = Fault::new(SceneError::UnknownName, "kind", "names no known effect", accepted())
            .found(format!("{:?}", abridged(name)))
            .help(suggest::nearest(name, names.iter().copied()).map(suggest::did_you_mean));
        entry.fail(fault)
    })
}
