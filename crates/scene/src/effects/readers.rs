//! How the keys of each kind of effect are read.

use super::effect::SceneEffect;
use super::specs::{HillSpec, TimeSpec, TrailersSpec};
use crate::error::SceneError;
use crate::quantity::KeyQuantity;
use crate::table::TomlTable;

type Read = Result<SceneEffect, SceneError>;

const fn finite(key: &'static str, unit: &'static str) -> KeyQuantity {
    KeyQuantity::finite(key, unit)
}

fn at_least_one(table: &TomlTable<'_>, keys: [&'static str; 2], what: &str) -> Result<(), SceneError> {
    match keys.iter().any(|key| table.get(key).is_some()) {
        true => Ok(()),
        false => Err(table.missing(keys[0], format!("{what}: `{}`, `{}` or both", keys[0], keys[1]))),
    }
}

pub(super) fn slope(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::Slope { gravity: table.required_pair(&finite("gravity", "m/s^2"))? })
}

pub(super) fn bowl(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::Bowl {
        stiffness: table.required_pair(&finite("stiffness", "N/m"))?,
        center: table.pair(&finite("center", "m"))?.unwrap_or([0.0; 2]),
    })
}

pub(super) fn egg_crate(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::EggCrate {
        height: table.required(&finite("height", "J"))?,
        wave_number: table.required_pair(&finite("wave_number", "1/m"))?,
    })
}

pub(super) fn hills(table: &TomlTable<'_>) -> Read {
    let accepted = "a list of tables `{height, x, y, width}`, the height in J, lengths in m";
    let read = |hill: &TomlTable<'_>| {
        Ok(HillSpec {
            height: hill.required(&finite("height", "J"))?,
            x: hill.required(&finite("x", "m"))?,
            y: hill.required(&finite("y", "m"))?,
            width: hill.required(&KeyQuantity::positive("width", "m"))?,
        })
    };
    let hills = table.tables("hills", &["height", "x", "y", "width"], accepted)?;
    Ok(SceneEffect::Hills { hills: hills.iter().map(read).collect::<Result<_, _>>()? })
}

pub(super) fn flywheel(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::Flywheel {
        inertia: table.required(&KeyQuantity::positive("inertia", "kg m^2"))?,
        rotor_rate: table.number(&finite("rotor_rate", "rad/s"))?.unwrap_or(0.0),
        torque: table.time_function(&finite("torque", "N m"))?,
    })
}

pub(super) fn drag(table: &TomlTable<'_>) -> Read {
    at_least_one(table, ["along", "turning"], "a coefficient of drag")?;
    Ok(SceneEffect::Drag {
        along: table.number(&KeyQuantity::not_negative("along", "kg/s"))?.unwrap_or(0.0),
        turning: table.number(&KeyQuantity::not_negative("turning", "kg m^2/s"))?.unwrap_or(0.0),
    })
}

pub(super) fn quadratic_drag(table: &TomlTable<'_>) -> Read {
    at_least_one(table, ["along", "turning"], "a coefficient of drag")?;
    Ok(SceneEffect::QuadraticDrag {
        along: table.number(&KeyQuantity::not_negative("along", "kg/m"))?.unwrap_or(0.0),
        turning: table.number(&KeyQuantity::not_negative("turning", "kg m^2"))?.unwrap_or(0.0),
    })
}

/// The speed (m/s) or turn rate (rad/s) below which friction is viscous, where a scene does not say it.
const SMOOTHING: f64 = 0.01;

pub(super) fn friction(table: &TomlTable<'_>) -> Read {
    at_least_one(table, ["along", "turning"], "a force or a torque of friction")?;
    let number = |quantity: KeyQuantity, left_out: f64| Ok(table.number(&quantity)?.unwrap_or(left_out));
    Ok(SceneEffect::Friction {
        along: number(KeyQuantity::not_negative("along", "N"), 0.0)?,
        smoothing: number(KeyQuantity::positive("smoothing", "m/s"), SMOOTHING)?,
        turning: number(KeyQuantity::not_negative("turning", "N m"), 0.0)?,
        turning_smoothing: number(KeyQuantity::positive("turning_smoothing", "rad/s"), SMOOTHING)?,
    })
}

pub(super) fn thrust(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::Thrust { force: table.required_function(&finite("force", "N"))? })
}

pub(super) fn torque(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::Torque { torque: table.required_function(&finite("torque", "N m"))? })
}

pub(super) fn moving_mass(table: &TomlTable<'_>) -> Read {
    at_least_one(table, ["x", "y"], "the place of the mass in the body, in m")?;
    let place = |key| {
        let function = table.time_function(&finite(key, "m"))?;
        Ok(function.unwrap_or(TimeSpec::Constant(0.0)))
    };
    let mass = table.required(&KeyQuantity::positive("mass", "kg"))?;
    Ok(SceneEffect::MovingMass { mass, x: place("x")?, y: place("y")? })
}

pub(super) fn servo(table: &TomlTable<'_>) -> Read {
    at_least_one(table, ["speed", "turn_rate"], "what the servo imposes")?;
    Ok(SceneEffect::Servo {
        speed: table.time_function(&finite("speed", "m/s"))?,
        turn_rate: table.time_function(&finite("turn_rate", "rad/s"))?,
    })
}

pub(super) fn tracer(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::Tracer { path: table.path("path")? })
}

pub(super) fn turntable(table: &TomlTable<'_>) -> Read {
    Ok(SceneEffect::Turntable { rate: table.required(&finite("rate", "rad/s"))? })
}

/// The most trailers that a scene may have.
const MOST_TRAILERS: f64 = 100_000.0;

pub(super) fn trailers(table: &TomlTable<'_>) -> Read {
    let count = table.required(&KeyQuantity::finite("count", "blades"))?;
    if count.fract() != 0.0 || !(1.0..=MOST_TRAILERS).contains(&count) {
        let accepted = format!("a whole number from 1 to {MOST_TRAILERS}");
        return Err(table.wrong("count", "is not a number of trailers", accepted));
    }
    let count = count as usize;
    let each = |quantity: &KeyQuantity| {
        let Some(list) = table.number_or_numbers(quantity)? else { return Ok(None) };
        match list.len() {
            1 => Ok(Some(list)),
            length if length == count => Ok(Some(list)),
            _ => {
                let accepted = format!("a number, or a list of {count}, in {}", quantity.unit);
                Err(table.wrong(quantity.key, "has the wrong length", accepted))
            }
        }
    };
    let needed = |quantity: KeyQuantity| {
        each(&quantity)?.ok_or_else(|| table.missing(quantity.key, format!("{}, or a list", quantity.accepted())))
    };
    let headings = table.number_or_numbers(&KeyQuantity::finite("headings", "rad"))?.unwrap_or_default();
    if headings.len() > count {
        let accepted = format!("a list of at most {count} numbers, in rad");
        return Err(table.wrong("headings", "are more than the trailers", accepted));
    }
    Ok(SceneEffect::Trailers(TrailersSpec {
        count,
        mass: needed(KeyQuantity::positive("mass", "kg"))?,
        inertia: needed(KeyQuantity::positive("inertia", "kg m^2"))?,
        offset: each(&KeyQuantity::finite("offset", "m"))?.unwrap_or_else(|| vec![0.0]),
        hitch: each(&KeyQuantity::finite("hitch", "m"))?.unwrap_or_else(|| vec![0.0]),
        bar: needed(KeyQuantity::positive("bar", "m"))?,
        headings,
    }))
}
