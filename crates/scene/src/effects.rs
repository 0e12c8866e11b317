use crate::effect::{EFFECTS, HillSpec, SceneEffect, TimeSpec, TrailersSpec};
use crate::error::SceneError;
use crate::fault::Fault;
use crate::keys::abridged;
use crate::quantity::Quantity;
use crate::suggest;
use crate::table::Table;
use sleigh::Sleigh;
use toml::de::DeValue;

/// Reads the entries of `[[effects]]`.
pub(crate) fn read(root: &Table<'_>, sleigh: &Sleigh) -> Result<Vec<SceneEffect>, SceneError> {
    let (mut effects, mut tables): (Vec<SceneEffect>, Vec<Table<'_>>) = (Vec::new(), Vec::new());
    for entry in root.entries_of("effects", "a list of tables, each headed `[[effects]]`")? {
        let (kind, keys, _) = kind_of(&entry)?;
        let known: Vec<&str> = ["kind"].into_iter().chain(keys.iter().copied()).collect();
        let path = entry.path_of(kind);
        let table = entry.named(path).with_known_keys(&known)?;
        let effect = read_one(&table, kind)?;
        check_company(&table, &effect, &effects, sleigh.offset())?;
        check_energy(&table, &effect, sleigh)?;
        effects.push(effect);
        tables.push(table);
        check_train(&tables, &effects)?;
    }
    Ok(effects)
}

/// The row of [`EFFECTS`] that the entry's `kind` names.
fn kind_of(entry: &Table<'_>) -> Result<&'static (&'static str, &'static [&'static str], &'static str), SceneError> {
    let names: Vec<&str> = EFFECTS.iter().map(|(name, _, _)| *name).collect();
    let accepted = || format!("one of {}", suggest::list(&names));
    let kind = entry.get("kind").ok_or_else(|| entry.missing("kind", accepted()))?;
    let DeValue::String(name) = kind.get_ref() else {
        return Err(entry.wrong_type("kind", kind, accepted()));
    };
    EFFECTS.iter().find(|(known, _, _)| known == name).ok_or_else(|| {
        let fault = Fault {
            variant: SceneError::UnknownName,
            key: "kind",
            problem: "names no known effect".to_owned(),
            found: Some(format!("{:?}", abridged(name))),
            accepted: accepted(),
            help: suggest::nearest(name, names.iter().copied()).map(suggest::did_you_mean),
        };
        entry.fail(fault)
    })
}

/// Reads the keys of one effect.
fn read_one(table: &Table<'_>, kind: &str) -> Result<SceneEffect, SceneError> {
    const fn finite(key: &'static str, unit: &'static str) -> Quantity {
        Quantity::finite(key, unit)
    }
    let at_least_one = |keys: [&'static str; 2], what: &str| match keys.iter().any(|key| table.get(key).is_some()) {
        true => Ok(()),
        false => Err(table.missing(keys[0], format!("{what}: `{}`, `{}` or both", keys[0], keys[1]))),
    };
    Ok(match kind {
        "slope" => SceneEffect::Slope { gravity: table.required_pair(&finite("gravity", "m/s^2"))? },
        "bowl" => SceneEffect::Bowl {
            stiffness: table.required_pair(&finite("stiffness", "N/m"))?,
            center: table.pair(&finite("center", "m"))?.unwrap_or([0.0; 2]),
        },
        "egg_crate" => SceneEffect::EggCrate {
            height: table.required(&finite("height", "J"))?,
            wave_number: table.required_pair(&finite("wave_number", "1/m"))?,
        },
        "hills" => SceneEffect::Hills { hills: hills(table)? },
        "flywheel" => SceneEffect::Flywheel {
            inertia: table.required(&Quantity::positive("inertia", "kg m^2"))?,
            rotor_rate: table.number(&finite("rotor_rate", "rad/s"))?.unwrap_or(0.0),
            torque: table.time_function(&finite("torque", "N m"))?,
        },
        "drag" => {
            at_least_one(["along", "turning"], "a coefficient of drag")?;
            SceneEffect::Drag {
                along: table.number(&Quantity::not_negative("along", "kg/s"))?.unwrap_or(0.0),
                turning: table.number(&Quantity::not_negative("turning", "kg m^2/s"))?.unwrap_or(0.0),
            }
        }
        "thrust" => SceneEffect::Thrust { force: table.required_function(&finite("force", "N"))? },
        "torque" => SceneEffect::Torque { torque: table.required_function(&finite("torque", "N m"))? },
        "moving_mass" => {
            at_least_one(["x", "y"], "the place of the mass in the body, in m")?;
            let place = |key| {
                let function = table.time_function(&finite(key, "m"))?;
                Ok(function.unwrap_or(TimeSpec::Constant(0.0)))
            };
            let mass = table.required(&Quantity::positive("mass", "kg"))?;
            SceneEffect::MovingMass { mass, x: place("x")?, y: place("y")? }
        }
        "servo" => {
            at_least_one(["speed", "turn_rate"], "what the servo imposes")?;
            SceneEffect::Servo {
                speed: table.time_function(&finite("speed", "m/s"))?,
                turn_rate: table.time_function(&finite("turn_rate", "rad/s"))?,
            }
        }
        "tracer" => SceneEffect::Tracer { path: table.path("path")? },
        "trailers" => SceneEffect::Trailers(trailers(table)?),
        _ => SceneEffect::Turntable { rate: table.required(&finite("rate", "rad/s"))? },
    })
}

/// The most trailers that a scene may have.
const MOST_TRAILERS: f64 = 100_000.0;

fn trailers(table: &Table<'_>) -> Result<TrailersSpec, SceneError> {
    let count = table.required(&Quantity::finite("count", "blades"))?;
    if count.fract() != 0.0 || !(1.0..=MOST_TRAILERS).contains(&count) {
        let accepted = format!("a whole number from 1 to {MOST_TRAILERS}");
        return Err(table.wrong("count", "is not a number of trailers", accepted));
    }
    let count = count as usize;
    let each = |quantity: &Quantity| {
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
    let needed = |quantity: Quantity| {
        each(&quantity)?.ok_or_else(|| table.missing(quantity.key, format!("{}, or a list", quantity.accepted())))
    };
    let headings = table.number_or_numbers(&Quantity::finite("headings", "rad"))?.unwrap_or_default();
    if headings.len() > count {
        let accepted = format!("a list of at most {count} numbers, in rad");
        return Err(table.wrong("headings", "are more than the trailers", accepted));
    }
    Ok(TrailersSpec {
        count,
        mass: needed(Quantity::positive("mass", "kg"))?,
        inertia: needed(Quantity::positive("inertia", "kg m^2"))?,
        offset: each(&Quantity::finite("offset", "m"))?.unwrap_or_else(|| vec![0.0]),
        hitch: each(&Quantity::finite("hitch", "m"))?.unwrap_or_else(|| vec![0.0]),
        bar: needed(Quantity::positive("bar", "m"))?,
        headings,
    })
}

fn hills(table: &Table<'_>) -> Result<Vec<HillSpec>, SceneError> {
    let accepted = "a list of tables `{height, x, y, width}`, the height in J, lengths in m";
    let read = |hill: &Table<'_>| {
        Ok(HillSpec {
            height: hill.required(&Quantity::finite("height", "J"))?,
            x: hill.required(&Quantity::finite("x", "m"))?,
            y: hill.required(&Quantity::finite("y", "m"))?,
            width: hill.required(&Quantity::positive("width", "m"))?,
        })
    };
    table.tables("hills", &["height", "x", "y", "width"], accepted)?.iter().map(read).collect()
}

/// Whether it changes the coordinates or the constraints, or jumps in time: what a train does not carry.
fn changes_body(effect: &SceneEffect) -> bool {
    match effect {
        SceneEffect::Flywheel { .. }
        | SceneEffect::Servo { .. }
        | SceneEffect::Tracer { .. }
        | SceneEffect::Turntable { .. } => true,
        SceneEffect::Thrust { force: function } | SceneEffect::Torque { torque: function } => {
            matches!(function, TimeSpec::Table { .. })
        }
        _ => false,
    }
}

/// Refuses imposed velocities whose kinetic energy is too large for a number.
fn check_energy(table: &Table<'_>, effect: &SceneEffect, sleigh: &Sleigh) -> Result<(), SceneError> {
    let SceneEffect::Servo { speed, turn_rate } = effect else { return Ok(()) };
    let inertia = sleigh.inertia() + sleigh.mass() * sleigh.offset().powi(2);
    for (key, function, mass, unit) in
        [("speed", speed, sleigh.mass(), "m/s"), ("turn_rate", turn_rate, inertia, "rad/s")]
    {
        let largest = function.as_ref().map_or(0.0, TimeSpec::largest);
        if !(0.5 * mass * largest * largest).is_finite() {
            let most = (f64::MAX / mass.max(1.0)).sqrt();
            let accepted = format!("values from -L to L with L = {most:.3e}, in {unit}");
            return Err(table.wrong(key, "makes the kinetic energy too large for a number", accepted));
        }
    }
    Ok(())
}

/// Refuses what does not act on a train, at the effect that does not.
fn check_train(tables: &[Table<'_>], effects: &[SceneEffect]) -> Result<(), SceneError> {
    if !effects.iter().any(|effect| matches!(effect, SceneEffect::Trailers(_))) {
        return Ok(());
    }
    let Some((table, effect)) = tables.iter().zip(effects).find(|(_, effect)| changes_body(effect)) else {
        return Ok(());
    };
    let table_of_times = match effect {
        SceneEffect::Thrust { .. } => Some("force"),
        SceneEffect::Torque { .. } => Some("torque"),
        _ => None,
    };
    if let Some(key) = table_of_times {
        let problem = "is a table of times, which does not act on a train: the scene has `trailers`";
        return Err(table.wrong(key, problem, "a number or `{amplitude, frequency, phase}`".to_owned()));
    }
    let accepted = "what acts on its coordinates: `slope`, `bowl`, `egg_crate`, `hills` for every blade, `drag`, \
                    `thrust`, `torque` and `moving_mass` for the first, without tables of times";
    Err(table.wrong("kind", "cannot act on a train: the scene has `trailers`", accepted.to_owned()))
}

/// Refuses what does not go together: a second body, two ways to impose a velocity, what the sleigh cannot do.
fn check_company(table: &Table<'_>, new: &SceneEffect, others: &[SceneEffect], offset: f64) -> Result<(), SceneError> {
    let only_once = matches!(
        new,
        SceneEffect::Flywheel { .. }
            | SceneEffect::Servo { .. }
            | SceneEffect::Tracer { .. }
            | SceneEffect::Turntable { .. }
            | SceneEffect::Trailers(_)
    );
    if only_once && others.iter().any(|other| other.kind() == new.kind()) {
        return Err(table.wrong("kind", "is there already", format!("one `{}` in a scene", new.kind())));
    }
    let imposes = |effect: &SceneEffect| matches!(effect, SceneEffect::Servo { .. } | SceneEffect::Tracer { .. });
    if imposes(new) && others.iter().any(imposes) {
        let problem = "imposes velocities that another effect imposes already";
        return Err(table.wrong("kind", problem, "either a `servo` or a `tracer`".to_owned()));
    }
    if matches!(new, SceneEffect::Tracer { .. }) && offset == 0.0 {
        let problem = "cannot lead a centre of mass that lies at the blade, which does not move sideways";
        return Err(table.wrong("kind", problem, "a `tracer` where `sleigh.offset` is not 0".to_owned()));
    }
    if let SceneEffect::MovingMass { x, y, .. } = new {
        let jumps = |f: &TimeSpec| matches!(f, TimeSpec::Table { times, .. } if times.len() > 1);
        for (key, function) in [("x", x), ("y", y)] {
            if jumps(function) {
                let accepted = "a number or `{amplitude, frequency, phase}`, in m".to_owned();
                return Err(table.wrong(key, "would make the mass jump", accepted));
            }
        }
    }
    Ok(())
}
