use super::{SceneEffect, trailers};
use crate::error::SceneError;
use crate::quantity::KeyQuantity;
use crate::systems::Rotor;
use crate::table::TomlTable;
use sleigh::effects::{
    AnyEffect, Bowl, Drag, EggCrate, Friction, Hill, Hills, MovingMass, QuadraticDrag, Slope, Thrust, Torque,
};
use sleigh::{SleighError, TimeFunction};

/// A kind of effect: all that scenes, the program and its documents say of it is made from its row.
#[derive(Debug, Clone, Copy)]
pub struct EffectInfo {
    /// The name in files.
    pub name: &'static str,
    /// Its keys, beside `kind`.
    pub keys: &'static [&'static str],
    /// What the effect does, in a few words.
    pub summary: &'static str,
    /// Whether a scene may have only one effect of this kind, as for effects that replace the body.
    pub only_once: bool,
    /// Reads its keys.
    pub(super) read: fn(&TomlTable<'_>) -> Result<SceneEffect, SceneError>,
}

/// Every kind of effect, in the order of the documentation.
pub const EFFECTS: &[EffectInfo] = &[
    EffectInfo {
        name: "slope",
        keys: &["gravity"],
        summary: "uniform tangential gravity, gravity = [gx, gy] in m/s^2",
        only_once: false,
        read: |table| acting(table, Slope::new(table.required_pair(&finite("gravity", "m/s^2"))?)),
    },
    EffectInfo {
        name: "bowl",
        keys: &["stiffness", "center"],
        summary: "quadratic well at the centre of mass, stiffness = [kx, ky] in N/m",
        only_once: false,
        read: |table| {
            let stiffness = table.required_pair(&finite("stiffness", "N/m"))?;
            acting(table, Bowl::new(stiffness, table.pair(&finite("center", "m"))?.unwrap_or([0.0; 2])))
        },
    },
    EffectInfo {
        name: "egg_crate",
        keys: &["height", "wave_number"],
        summary: "periodic landscape V0 (cos(kx X) + cos(ky Y))",
        only_once: false,
        read: |table| {
            let height = table.required(&finite("height", "J"))?;
            acting(table, EggCrate::new(height, table.required_pair(&finite("wave_number", "1/m"))?))
        },
    },
    EffectInfo {
        name: "hills",
        keys: &["hills"],
        summary: "Gaussian hills, each {height, x, y, width}",
        only_once: false,
        read: |table| {
            let accepted = "a list of tables `{height, x, y, width}`, the height in J, lengths in m";
            let hill = |hill: &TomlTable<'_>| {
                Ok(Hill {
                    height: hill.required(&finite("height", "J"))?,
                    x: hill.required(&finite("x", "m"))?,
                    y: hill.required(&finite("y", "m"))?,
                    width: hill.required(&KeyQuantity::positive("width", "m"))?,
                })
            };
            let hills = table.tables("hills", &["height", "x", "y", "width"], accepted)?;
            acting(table, Hills::new(hills.iter().map(hill).collect::<Result<_, _>>()?))
        },
    },
    EffectInfo {
        name: "flywheel",
        keys: &["inertia", "rotor_rate", "torque"],
        summary: "rotor on the sleigh, free or with a motor torque",
        only_once: true,
        read: |table| {
            Ok(SceneEffect::Flywheel(Rotor {
                inertia: table.required(&KeyQuantity::positive("inertia", "kg m^2"))?,
                rate: table.number(&finite("rotor_rate", "rad/s"))?.unwrap_or(0.0),
                torque: table.time_function(&finite("torque", "N m"))?,
            }))
        },
    },
    EffectInfo {
        name: "drag",
        keys: &["along", "turning"],
        summary: "viscous drag along the blade and against turning",
        only_once: false,
        read: |table| {
            let [along, turning] = brake(table, "a coefficient of drag", ["kg/s", "kg m^2/s"])?;
            acting(table, Drag::new(along, turning))
        },
    },
    EffectInfo {
        name: "quadratic_drag",
        keys: &["along", "turning"],
        summary: "drag by the square of the speed, and of the turn rate",
        only_once: false,
        read: |table| {
            let [along, turning] = brake(table, "a coefficient of drag", ["kg/m", "kg m^2"])?;
            acting(table, QuadraticDrag::new(along, turning))
        },
    },
    EffectInfo {
        name: "friction",
        keys: &["along", "smoothing", "turning", "turning_smoothing"],
        summary: "Coulomb friction or rolling resistance along the blade and against turning, smoothed at rest",
        only_once: false,
        read: |table| {
            let [along, turning] = brake(table, "a force or a torque of friction", ["N", "N m"])?;
            let smoothing = |key, unit| Ok(table.number(&KeyQuantity::positive(key, unit))?.unwrap_or(SMOOTHING));
            let [slow, turning_slow] = [smoothing("smoothing", "m/s")?, smoothing("turning_smoothing", "rad/s")?];
            acting(table, Friction::new(along, slow, turning, turning_slow))
        },
    },
    EffectInfo {
        name: "thrust",
        keys: &["force"],
        summary: "force along the blade, constant or a function of time",
        only_once: false,
        read: |table| acting(table, Thrust::new(table.required_function(&finite("force", "N"))?)),
    },
    EffectInfo {
        name: "torque",
        keys: &["torque"],
        summary: "torque on the heading, constant or a function of time",
        only_once: false,
        read: |table| acting(table, Torque::new(table.required_function(&finite("torque", "N m"))?)),
    },
    EffectInfo {
        name: "moving_mass",
        keys: &["mass", "x", "y"],
        summary: "a mass moved in the body along a given path",
        only_once: false,
        read: |table| {
            at_least_one(table, ["x", "y"], "the place of the mass in the body, in m")?;
            let mass = table.required(&KeyQuantity::positive("mass", "kg"))?;
            let place = |key| {
                let function = table.time_function(&finite(key, "m"))?.unwrap_or(TimeFunction::Constant(0.0));
                if function.has_corners() {
                    let accepted = "a number, `{amplitude, frequency, phase}` or a smooth formula in `t`, in m";
                    return Err(table.wrong(key, "would make the mass or its velocity jump", accepted.to_owned()));
                }
                Ok(function)
            };
            made(table, MovingMass::new(mass, place("x")?, place("y")?)).map(SceneEffect::MovingMass)
        },
    },
    EffectInfo {
        name: "servo",
        keys: &["speed", "turn_rate"],
        summary: "imposed speed, turn rate or both",
        only_once: true,
        read: |table| {
            at_least_one(table, ["speed", "turn_rate"], "what the servo imposes")?;
            Ok(SceneEffect::Servo {
                speed: table.time_function(&finite("speed", "m/s"))?,
                turn_rate: table.time_function(&finite("turn_rate", "rad/s"))?,
            })
        },
    },
    EffectInfo {
        name: "tracer",
        keys: &["path"],
        summary: "centre of mass led along a closed path: the planimeter",
        only_once: true,
        read: |table| Ok(SceneEffect::Tracer { path: table.path("path")? }),
    },
    EffectInfo {
        name: "turntable",
        keys: &["rate"],
        summary: "a plane that turns about the origin",
        only_once: true,
        read: |table| Ok(SceneEffect::Turntable { rate: table.required(&finite("rate", "rad/s"))? }),
    },
    EffectInfo {
        name: "trailers",
        keys: &["count", "mass", "inertia", "offset", "hitch", "bar", "headings"],
        summary: "a train of further blades, each hinged to the one before it",
        only_once: true,
        read: |table| trailers::read(table).map(SceneEffect::Trailers),
    },
];

/// The speed (m/s) or turn rate (rad/s) below which friction is viscous, where a scene does not say it.
const SMOOTHING: f64 = 0.01;

const fn finite(key: &'static str, unit: &'static str) -> KeyQuantity {
    KeyQuantity::finite(key, unit)
}

/// The effect, or the error of its parameters; parameters in their ranges have none.
fn made<T>(table: &TomlTable<'_>, effect: Result<T, SleighError>) -> Result<T, SceneError> {
    effect.map_err(|error| table.wrong("kind", "has impossible parameters", error.to_string()))
}

/// An effect that acts by a potential or a force.
fn acting(table: &TomlTable<'_>, effect: Result<impl Into<AnyEffect>, SleighError>) -> Result<SceneEffect, SceneError> {
    made(table, effect).map(|effect| SceneEffect::Acting(effect.into()))
}

/// The numbers `along` and `turning` of a brake, in these units; at least one must be given.
fn brake(table: &TomlTable<'_>, what: &str, units: [&'static str; 2]) -> Result<[f64; 2], SceneError> {
    at_least_one(table, ["along", "turning"], what)?;
    let number = |key, unit| Ok(table.number(&KeyQuantity::not_negative(key, unit))?.unwrap_or(0.0));
    Ok([number("along", units[0])?, number("turning", units[1])?])
}

fn at_least_one(table: &TomlTable<'_>, keys: [&'static str; 2], what: &str) -> Result<(), SceneError> {
    match keys.iter().any(|key| table.get(key).is_some()) {
        true => Ok(()),
        false => Err(table.missing(keys[0], format!("{what}: `{}`, `{}` or both", keys[0], keys[1]))),
    }
}
