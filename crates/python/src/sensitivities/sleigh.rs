use super::motion::{Carried, DifferentiatedMotion, of_parameter, of_start};
use super::{Asked, SensitivityRows, no_key, refused};
use cli::Refusal;
use dla::AnyTangent;
use lagrangian::Scalar;
use scene::{Built, PARAMETERS, Scene, Started};

/// The keys of the start.
const START: [&str; 5] = ["start.x", "start.y", "start.heading", "start.speed", "start.turn_rate"];

/// The columns that have derivatives. A scene with a rotor also has the columns of the rotor.
const COLUMNS: [&str; 5] = ["x", "y", "heading", "speed", "turn_rate"];
const OF_ROTOR: [&str; 2] = ["rotor_angle", "rotor_rate"];
const FURTHER: [&str; 3] = ["energy", "center_x", "center_y"];

/// The numbers of a run of a sleigh, with their derivatives in a block of keys.
pub(super) fn rows(scene: &Scene, asked: &Asked<'_>, keys: &[String]) -> Result<SensitivityRows, Refusal> {
    let Started { system, q, v } = scene.system().map_err(|error| refused(&error))?;
    let family = scene.family().map_err(|error| refused(&error))?.ok_or_else(imposed)?;
    let member = system.member(&family).ok_or_else(imposed)?;
    let start = keys.iter().map(|key| tangent(key, &q, &v)).collect::<Result<Vec<_>, _>>()?;
    let rotor: &[&str] = if q.len() > 3 { &OF_ROTOR } else { &[] };
    let known: Vec<String> = COLUMNS.iter().chain(rotor).chain(&FURTHER).map(|name| (*name).to_owned()).collect();
    let usual = known.len() - FURTHER.len();
    let told = |at: &Carried<'_>| {
        let Carried { q, v, p, .. } = at;
        let (sin, cos) = q[2].sin_cos();
        let mut told = vec![q[0], q[1], q[2], v[0] * cos + v[1] * sin, v[2]];
        told.extend(q.iter().zip(v).skip(3).flat_map(|(angle, rate)| [*angle, *rate]));
        told.extend([at.energy(), q[0] + cos * p[2], q[1] + sin * p[2]]);
        told
    };
    let motion = DifferentiatedMotion { system: Built::Sleigh(&*system), family: &*member, q, v };
    motion.rows(asked, start, (&known, usual), told)
}

fn imposed() -> Refusal {
    refused(&"the scene imposes velocities (servo, tracer), and its runs have no derivatives")
}

/// Whether a key is the known one, in full or by its name.
fn is(known: &str, key: &str) -> bool {
    known == key || known.split_once('.').is_some_and(|(_, name)| name == key)
}

/// The key in full.
pub(super) fn full_key(key: &str) -> Option<String> {
    START.iter().chain(&PARAMETERS).find(|known| is(known, key)).map(|known| (*known).to_owned())
}

/// How the run begins in a key.
fn tangent(key: &str, q: &[f64], v: &[f64]) -> Result<AnyTangent, Refusal> {
    if let Some(place) = PARAMETERS.iter().position(|known| is(known, key)) {
        return Ok(of_parameter(place));
    }
    let Some(place) = START.iter().position(|known| is(known, key)) else {
        return Err(no_key(key, &START.iter().chain(&PARAMETERS).copied().collect::<Vec<_>>().join(", ")));
    };
    let (sin, cos) = q[2].sin_cos();
    let (mut dq, mut dv) = (vec![0.0; q.len()], vec![0.0; q.len()]);
    match place {
        // The velocity turns with the blade.
        2 => (dq[2], dv[0], dv[1]) = (1.0, -v[1], v[0]),
        3 => (dv[0], dv[1]) = (cos, sin),
        4 => dv[2] = 1.0,
        place => dq[place] = 1.0,
    }
    Ok(of_start(dq, dv))
}
