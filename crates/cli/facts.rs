//! Descriptions of scenes for a person: names and values.

use crate::error::CliError;
use crate::inspect;
use crate::table::{counted, number};
use scene::{
    AnyEffect, AnyScene, BuildError, BuiltScene, Quantity, Rotor, Scene, SceneEffect, TextModel, TextScene,
    TrailersSpec,
};
use sleigh::effects::{Bowl, Drag, EggCrate, Friction, Hill, MovingMass, QuadraticDrag};
use sleigh::{ClosedPath, PathShape, SleighState, TimeFunction};

/// The description of a scene.
pub(crate) fn of(scene: &AnyScene) -> Result<Vec<(String, String)>, CliError> {
    Ok(match scene {
        AnyScene::Sleigh(scene) => of_sleigh(scene)?,
        AnyScene::Text(scene) => of_text(scene),
    })
}

/// The same with its method, for `noslip check`.
pub(crate) fn described(scene: &AnyScene) -> Result<Vec<(String, String)>, CliError> {
    inspect::moves(scene);
    let mut facts = of(scene)?;
    facts.push(("method".to_owned(), scene.run().method.clone()));
    Ok(facts)
}

/// The facts of a scene, with the state that it starts in.
fn of_sleigh(scene: &Scene) -> Result<Vec<(String, String)>, BuildError> {
    let built = scene.built()?;
    let (system, BuiltScene { q, v, .. }) = (built.system(), &built);
    let energy = system.mechanism().smooth_piece(0.0).energy(0.0, q, v);
    let Some(sleigh) = system.sleigh().filter(|sleigh| sleigh.train().is_none()) else {
        return Ok(listed(scene, &scene.start, energy, ""));
    };
    let start = sleigh.scene_piece(0.0).sleigh_state(q, v);
    let imposed = scene.effects.iter().map(SceneEffect::kind).find(|kind| matches!(*kind, "servo" | "tracer"));
    let imposed = imposed.map_or_else(String::new, |kind| format!(", as the {kind} imposes it"));
    Ok(listed(scene, &start, energy, &imposed))
}

/// The facts of a scene that starts in that state of its first blade, with that energy (J).
fn listed(scene: &Scene, start: &SleighState, energy: f64, imposed: &str) -> Vec<(String, String)> {
    let (sleigh, run, schedule) = (&scene.sleigh, &scene.run, scene.schedule());
    let mut facts = vec![
        ("mass m", format!("{} kg", number(sleigh.mass()))),
        ("inertia I about the centre of mass", format!("{} kg m²", number(sleigh.inertia()))),
        ("offset a of the centre of mass ahead of the blade", format!("{} m", number(sleigh.offset()))),
    ];
    facts.extend(scene.effects.iter().map(|effect| ("effect", words(effect))));
    let [x, y, heading] = [start.x, start.y, start.heading].map(number);
    let [speed, turn_rate] = [start.speed, start.turn_rate].map(number);
    facts.extend([
        ("start", format!("x = {x} m, y = {y} m, heading {heading} rad")),
        ("start velocity", format!("{speed} m/s along the blade, {turn_rate} rad/s{imposed}")),
        ("energy", format!("{} J", number(energy))),
        (
            "run",
            format!("{} s in {} of {} s", number(run.duration), counted(schedule.steps, "step"), number(schedule.step)),
        ),
    ]);
    facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// An effect, in words.
fn words(effect: &SceneEffect) -> String {
    match effect {
        SceneEffect::Acting(effect) => acting(effect),
        SceneEffect::Flywheel(Rotor { inertia, rate, torque }) => {
            let motor = match torque {
                Some(torque) => format!("motor torque {}", function(torque, "N m")),
                None => "running free".to_owned(),
            };
            format!("flywheel of {} kg m², initially at {} rad/s, {motor}", number(*inertia), number(*rate))
        }
        SceneEffect::MovingMass(MovingMass { mass, x, y }) => {
            let [ahead, left] = [x, y].map(|place| function(place, "m"));
            format!("moving mass of {} kg: {ahead} ahead of the blade, {left} to the left", number(*mass))
        }
        SceneEffect::Servo { speed, turn_rate } => {
            let speed = speed.as_ref().map(|speed| format!("speed {}", function(speed, "m/s")));
            let turn = turn_rate.as_ref().map(|rate| format!("turn rate {}", function(rate, "rad/s")));
            format!("servo imposes: {}", speed.into_iter().chain(turn).collect::<Vec<_>>().join(", "))
        }
        SceneEffect::Tracer { path } => format!("tracer leads the centre of mass: {}", round(path)),
        SceneEffect::Trailers(TrailersSpec { count, mass, bar, hitch, .. }) => {
            let all = |list: &[f64]| match list {
                [one] => number(*one),
                list => format!(
                    "{} to {}",
                    number(least(list)),
                    number(-least(&list.iter().map(|x| -x).collect::<Vec<_>>()))
                ),
            };
            let [mass, bar, hitch] = [mass, bar, hitch].map(|list| all(list));
            format!(
                "{} of {mass} kg, each blade {bar} m behind a hinge {hitch} m behind the blade before",
                counted(*count as u64, "trailer")
            )
        }
        SceneEffect::Turntable { rate } => format!("turntable: the plane turns at {} rad/s", number(*rate)),
    }
}

/// What acts by a potential or a force, in words.
fn acting(effect: &AnyEffect) -> String {
    match effect {
        AnyEffect::Slope(slope) => format!("slope: gravity {} m/s²", pair(&slope.gravity)),
        AnyEffect::Bowl(Bowl { stiffness, center }) => {
            let shape = if stiffness.contains(&0.0) { "valley" } else { "bowl" };
            format!("{shape} of stiffness {} N/m about {} m", pair(stiffness), pair(center))
        }
        AnyEffect::EggCrate(EggCrate { height, wave_number }) => {
            format!("egg crate of height {} J, wave numbers {} 1/m", number(*height), pair(wave_number))
        }
        AnyEffect::Hills(hills) => {
            let one = |hill: &Hill| {
                let [height, width] = [hill.height, hill.width].map(number);
                format!("{height} J at {} m, {width} m wide", pair(&[hill.x, hill.y]))
            };
            format!("hills: {}", hills.hills.iter().map(one).collect::<Vec<_>>().join("; "))
        }
        AnyEffect::Drag(Drag { along, turning }) => {
            format!("drag: {} kg/s along the blade, {} kg m²/s against turning", number(*along), number(*turning))
        }
        AnyEffect::QuadraticDrag(QuadraticDrag { along, turning }) => format!(
            "drag by the square: {} kg/m along the blade, {} kg m² against turning",
            number(*along),
            number(*turning)
        ),
        AnyEffect::Friction(Friction { along, smoothing, turning, turning_smoothing }) => format!(
            "friction: {} N along the blade above {} m/s, {} N m against turning above {} rad/s",
            number(*along),
            number(*smoothing),
            number(*turning),
            number(*turning_smoothing)
        ),
        AnyEffect::Thrust(thrust) => format!("thrust along the blade: {}", function(&thrust.force, "N")),
        AnyEffect::Torque(torque) => format!("torque on the heading: {}", function(&torque.torque, "N m")),
    }
}

fn least(list: &[f64]) -> f64 {
    list.iter().copied().fold(f64::INFINITY, f64::min)
}

fn pair([x, y]: &[f64; 2]) -> String {
    format!("({}, {})", number(*x), number(*y))
}

fn function(function: &TimeFunction, unit: &str) -> String {
    let points = |kind: &str, values: &[f64]| {
        let first = values.first().copied().map_or_else(String::new, number);
        format!("{kind} of {}, {first} {unit} at first", counted(values.len() as u64, "value"))
    };
    match function {
        TimeFunction::Constant(value) => format!("{} {unit}", number(*value)),
        TimeFunction::Sine { amplitude, frequency, phase } => {
            let shift = if *phase == 0.0 { String::new() } else { format!(" + {}", number(*phase)) };
            format!("{} sin({} t{shift}) {unit}", number(*amplitude), number(*frequency))
        }
        TimeFunction::Formula(formula) => format!("{} {unit}", formula.text().escape_debug()),
        TimeFunction::Table(table) => points("a table", table.values()),
        TimeFunction::Ramp(ramp) => points("ramps", ramp.values()),
        TimeFunction::Pulses(_) => format!("pulses in {unit}"),
    }
}

fn round(path: &ClosedPath) -> String {
    let shape = match path.shape() {
        PathShape::Circle { radius, center } => {
            format!("a circle of radius {} m about {} m", number(*radius), pair(center))
        }
        PathShape::Polygon(polygon) => format!("a polygon of {} vertices", polygon.vertices().len()),
    };
    format!("{shape}, once every {} s", number(path.period()))
}

/// The description of a scene for a person: names and values.
fn of_text(scene: &TextScene) -> Vec<(String, String)> {
    let (model, start, run, schedule) = (&scene.model, &scene.start, &scene.run, scene.schedule());
    let geometry = model.geometry(start);
    let mut facts: Vec<(&str, String)> = Vec::new();
    let units = model.coordinates().iter().map(|of| match of.unit.name() {
        "" => of.name.clone(),
        unit => format!("{} [{unit}]", of.name),
    });
    facts.push(("coordinates", units.collect::<Vec<_>>().join(", ")));
    let parameters = scene.words.parameters.iter().map(|(name, value)| format!("{name} = {}", number(*value)));
    let parameters: Vec<String> = parameters.collect();
    if !parameters.is_empty() {
        facts.push(("parameters", parameters.join(", ")));
    }
    let positions = match model.positions() {
        0 => String::new(),
        k => format!(", {k} of them on positions"),
    };
    facts.push(("constraints", format!("{}{positions}, rank {} at the start", model.constraints(), geometry.rank)));
    if model.constraints() > 0 {
        facts.push(("integrable", geometry.integrability()));
        facts.push(("growth vector", geometry.growth_told()));
        let basis = match (model.gives_basis(), model.is_assembly()) {
            (true, _) => "given",
            (false, false) => "derived",
            (false, true) => "none: no reduced equations of a system of this size",
        };
        facts.push(("basis of admissible velocities", basis.to_owned()));
    }
    if model.has_forces() {
        facts.push(("forces", scene.words.forces.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ")));
    }
    if model.depends_on_time() {
        facts.push(("depends on time", "yes".to_owned()));
    }
    let [lagrangian, constraint, force] = model.operations();
    facts.push((
        "operations",
        format!("{lagrangian} for the Lagrangian, {constraint} for the constraints, {force} for the forces"),
    ));
    let numbers = |what: &[(String, String)]| {
        what.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
    };
    let state = state_of(model, &start.q, &start.v);
    let n = model.coordinates().len();
    facts.push(("start", numbers(&state[..n])));
    facts.push(("start velocity", numbers(&state[n..2 * n])));
    if state.len() > 2 * n {
        facts.push(("outputs", numbers(&state[2 * n..])));
    }
    facts.push(("energy", format!("{} J", number(model.energy(0.0, &start.q, &start.v)))));
    facts.push((
        "run",
        format!("{} s in {} of {} s", number(run.duration), counted(schedule.steps, "step"), number(schedule.step)),
    ));
    facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Coordinates, rates and outputs, with their units.
fn state_of(model: &TextModel, q: &[f64], v: &[f64]) -> Vec<(String, String)> {
    let line = |of: &Quantity, x: f64| (of.name.clone(), format!("{} {}", number(x), of.unit).trim_end().to_owned());
    let outputs = model.told(0.0, q, v);
    let values = q.iter().chain(v).chain(&outputs);
    scene::text_quantities(model).iter().zip(values).map(|(of, x)| line(of, *x)).collect()
}
