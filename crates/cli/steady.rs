//! Steady motions as `noslip equilibria` tells them, whatever their scene is.

use crate::table;
use harness::Method;
use harness::analysis::{Equilibrium, MapError, StepLimit};
use scene::{Built, Coordinate, SceneSystem};
use serde_json::{Map, Value, json};
use sleigh::SleighState;

/// A steady motion as fields for a program and as lines for a person.
pub(crate) struct SteadyMotion {
    pub(crate) fields: Map<String, Value>,
    pub(crate) lines: Vec<(&'static str, String)>,
}

/// The names of the coordinates of a sleigh.
const COORDINATES: [&str; 4] = ["x", "y", "heading", "rotor"];

/// A steady motion of a system, in the words of its scene.
pub(crate) fn motion(system: &Built<'_>, e: &Equilibrium) -> SteadyMotion {
    match system {
        Built::Sleigh(sleigh) => of_sleigh(*sleigh, e),
        Built::Text(text) => of_text(text.model().coordinates(), e),
    }
}

fn fields<const K: usize>(fields: [(&str, Value); K]) -> Map<String, Value> {
    fields.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

fn of_sleigh(system: &dyn SceneSystem, e: &Equilibrium) -> SteadyMotion {
    let SleighState { x, y, heading, speed, turn_rate } = system.sleigh_state(&e.q, &e.v);
    let rotor_rate = system.rotor(&e.q, &e.v).map(|[_, rate]| rate);
    let depends_on: Vec<&str> = e.shape.iter().filter_map(|i| COORDINATES.get(*i).copied()).collect();
    let mut what = format!("{} m/s, {} rad/s", table::number(speed), table::number(turn_rate));
    if let Some(rate) = rotor_rate {
        what += &format!(", rotor {} rad/s", table::number(rate));
    }
    if !depends_on.is_empty() {
        let [x, y, heading] = [x, y, heading].map(table::number);
        what += &format!(", at x = {x} m, y = {y} m, heading {heading} rad");
    }
    let fields = fields([
        ("speed", json!(speed)),
        ("turn_rate", json!(turn_rate)),
        ("rotor_rate", json!(rotor_rate)),
        ("x", json!(x)),
        ("y", json!(y)),
        ("heading", json!(heading)),
        ("depends_on", json!(depends_on)),
    ]);
    SteadyMotion { fields, lines: vec![("motion", what)] }
}

/// The rates by their names, and the coordinates on which the equations depend, with their values.
fn of_text(coordinates: &[Coordinate], e: &Equilibrium) -> SteadyMotion {
    let rates: Vec<_> = coordinates.iter().zip(&e.v).map(|(of, rate)| (format!("{}'", of.name), *rate)).collect();
    let place = e.place.iter().filter_map(|&i| Some((coordinates.get(i)?.name.clone(), e.q[i])));
    let place: Vec<(String, f64)> = place.collect();
    let object =
        |of: &[(String, f64)]| -> Value { of.iter().map(|(name, value)| (name.clone(), json!(value))).collect() };
    let told = |of: &[(String, f64)]| {
        of.iter().map(|(name, value)| format!("{name} = {}", table::number(*value))).collect::<Vec<_>>().join(", ")
    };
    let fields = fields([("rates", object(&rates)), ("depends_on", object(&place))]);
    let place = if place.is_empty() { "any".to_owned() } else { told(&place) };
    SteadyMotion { fields, lines: vec![("motion", told(&rates)), ("place", place)] }
}

/// How stable a steady motion is, of the flow and of a method.
pub(crate) struct Stability {
    /// Number of parameters of the family of steady motions around this one.
    pub(crate) family: usize,
    pub(crate) stable: bool,
    /// The eigenvalues of the flow (1/s), real and imaginary part.
    pub(crate) flow: Vec<[f64; 2]>,
    /// The eigenvalues of a step of the method.
    pub(crate) map: Result<Vec<[f64; 2]>, MapError>,
    /// The longest step; `None` if the flow is unstable.
    pub(crate) limit: Option<StepLimit>,
}

impl Stability {
    /// The object of a motion; it begins with the fields of the scene.
    pub(crate) fn object(&self, mut motion: Map<String, Value>) -> Value {
        let fields = [
            ("family", json!(self.family)),
            ("stable", json!(self.stable)),
            ("flow", json!(complex_json(&self.flow))),
            ("map", json!(self.map.as_deref().ok().map(complex_json))),
            ("map_failure", json!(self.map.as_ref().err().map(MapError::to_string))),
            ("step_limit", json!(self.limit.and_then(StepLimit::step))),
            ("step_limit_reason", json!(self.limit.map(StepLimit::reason))),
            ("stable_up_to", json!(self.limit.and_then(StepLimit::stable_up_to))),
        ];
        motion.extend(fields.map(|(key, value)| (key.to_owned(), value)));
        Value::Object(motion)
    }

    /// The lines of a motion; they begin with the lines of the scene.
    pub(crate) fn lines(&self, mut motion: Vec<(&'static str, String)>) -> String {
        motion.extend([
            ("", if self.stable { "stable".to_owned() } else { "unstable".to_owned() }),
            ("parameters", self.family.to_string()),
            ("flow [1/s]", complex_numbers(&self.flow)),
            ("map", self.map.as_deref().map_or_else(MapError::to_string, complex_numbers)),
            ("longest step", limit_told(self.limit)),
        ]);
        format!("\n{}", table::aligned(&motion))
    }
}

/// The extent of the search for steady motions.
pub(crate) struct Searched {
    pub(crate) places: usize,
    /// Largest distance from the start in a coordinate (m or rad).
    pub(crate) reach: f64,
    pub(crate) motions: usize,
}

impl Searched {
    /// For a person.
    pub(crate) fn told(&self) -> String {
        let Self { places, reach, motions } = self;
        let places = match places {
            1 => "from the start".to_owned(),
            _ => format!("from {places} places up to {} from the start in each coordinate", table::number(*reach)),
        };
        let velocities = if *motions == 1 { "velocity" } else { "velocities" };
        format!(
            "\nsearched: rest {places}, steady motions from {motions} {velocities}; of a family one is shown, and there may \
                be others further away\n"
        )
    }
}

/// The object that `noslip equilibria --json` prints; `step` in s.
pub(crate) fn object(
    scene: &str,
    method: &Method,
    step: f64,
    (motions, searched): (impl Iterator<Item = Value>, &Searched),
) -> Value {
    let Searched { places, reach, motions: velocities } = searched;
    json!({
        "scene": scene, "method": method.info().name, "step": step, "equilibria": motions.collect::<Vec<_>>(),
        "searched": {"places": places, "reach": reach, "velocities": velocities},
    })
}

/// The heading above the motions of a scene.
pub(crate) fn heading((title, name): (&str, &str), method: &Method, step: f64) -> String {
    format!("{title} ({name}): steady motions, and those of {} with steps of {step} s\n", method.info().name)
}

/// The longest step of a method near a steady motion, in words.
fn limit_told(limit: Option<StepLimit>) -> String {
    match limit {
        None => "none: the motion itself is unstable".to_owned(),
        Some(StepLimit::Beyond(step)) => format!("none found up to {} s", table::number(step)),
        Some(StepLimit::Unstable(step)) => format!("{} s: beyond, the map is unstable", table::number(step)),
        Some(StepLimit::Ends(step, why)) => {
            format!("not known: stable up to {} s, and for longer steps: {why}", table::number(step))
        }
        Some(StepLimit::Unknown(why)) => format!("not known: {why}"),
    }
}

/// Complex numbers for a program.
fn complex_json(values: &[[f64; 2]]) -> Vec<Value> {
    values.iter().map(|[re, im]| json!({"re": re, "im": im})).collect()
}

/// Complex numbers for a person.
fn complex_numbers(values: &[[f64; 2]]) -> String {
    let number = |[re, im]: &[f64; 2]| match *im {
        // Without the sign of a zero.
        0.0 => table::number(*re + 0.0),
        im => format!("{} {} {} i", table::number(*re), if im < 0.0 { '-' } else { '+' }, table::number(im.abs())),
    };
    values.iter().map(number).collect::<Vec<_>>().join(", ")
}
