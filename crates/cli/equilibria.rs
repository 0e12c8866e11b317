use crate::args::EquilibriaArguments;
use crate::chart_file::{check_picture, write_picture};
use crate::error::CliError;
use crate::{inspect, table, terminal};
use dla::Trajectory;
use harness::analysis::{
    DiscreteMap, Equilibrium, EquilibriumError, MapError, StepLimit, has_map, relative_equilibria,
};
use harness::{Method, Run};
use report::{Chart, Layer};
use scene::{AnyScene, Built, BuiltScene, Coordinate, Scene, SceneSystem};
use serde_json::{Value, json};
use sleigh::SleighState;

/// Starts of the phase portrait's orbits: speeds as fractions of the speed that has the scene's energy, and the turn rate as a fraction of
/// that speed (rad/m), both scaled alike.
const PORTRAIT: ([f64; 3], f64) = ([0.4, 0.7, 1.0], 0.03);

/// `noslip equilibria`: the steady motions of a scene, and how stable they are, of the flow and of a method.
pub(crate) fn equilibria(arguments: &EquilibriaArguments) -> Result<(), CliError> {
    let (shared, picture) = (&arguments.scene, arguments.picture.as_deref());
    let scene = inspect::load(shared, arguments.method.as_deref())?;
    let method = inspect::method(scene.run())?;
    if !has_map(&method) {
        return Err(CliError::NotDifferentiated { method: method.info().name });
    }
    if picture.is_some() && matches!(scene, AnyScene::Text(_)) {
        let problem = "--picture draws the speed and the turn rate of a sleigh; the scene is a system of text";
        return Err(CliError::Request(problem.to_owned()));
    }
    check_picture(picture, shared)?;
    inspect::moves(&scene);
    let built = scene.built_for_analysis()?;
    let (system, h) = (built.system(), scene.run().actual_step());
    let mechanism = system.mechanism();
    if !mechanism.jump_times(0.0, scene.run().duration).is_empty() {
        return Err(EquilibriumError::TimeDependent.into());
    }
    let all = relative_equilibria(&*mechanism, system.own(), &built.q, &built.v)?;
    let map = DiscreteMap::new(&*mechanism, system.own(), &method);
    let motions: Vec<SteadyMotion> = all.found.iter().map(|found| SteadyMotion::of(&system, found, &map, h)).collect();
    if let AnyScene::Sleigh(scene) = &scene {
        write_picture(picture, shared, || portrait(scene, &method, &built, &all.found))?;
    }
    let (name, [places, velocities]) = (method.info().name, [all.places, all.motions]);
    if shared.json {
        return terminal::print_json(&json!({
            "scene": scene.name(), "method": name, "step": h,
            "equilibria": motions.into_iter().map(SteadyMotion::object).collect::<Vec<Value>>(),
            "searched": {"places": places, "reach": all.reach, "velocities": velocities},
        }));
    }
    let heading =
        format!("{} ({}): steady motions, and those of {name} with steps of {h} s", scene.title(), scene.name());
    let told = motions.into_iter().map(SteadyMotion::told).collect::<String>();
    terminal::print(&(table::wrapped(&heading) + &told + &searched(places, all.reach, velocities)))
}

/// The phase portrait of a sleigh: steady motions, and orbits.
fn portrait(scene: &Scene, method: &Method, built: &BuiltScene, found: &[Equilibrium]) -> Chart {
    let orbits = orbits(scene, method, built);
    let steady = |stable: bool| {
        let rates = |e: &Equilibrium| {
            let at = built.system().sleigh()?.sleigh_state(&e.q, &e.v);
            Some(vec![[at.speed, at.turn_rate]])
        };
        found.iter().filter(|e| e.stable == stable).filter_map(rates).collect()
    };
    let starts = orbits.iter().filter_map(|orbit| orbit.first().map(|start| vec![*start])).collect();
    let kinds =
        [("orbits", orbits), ("stable", steady(true)), ("unstable", steady(false)), ("where orbits begin", starts)];
    let kinds = kinds.into_iter().filter(|(_, curves)| !curves.is_empty());
    Chart {
        title: format!("{}: phase portrait", scene.title),
        axes: ["speed [m/s]".to_owned(), "turn rate [rad/s]".to_owned()],
        decades: [false; 2],
        layers: kinds.map(|(label, curves)| Layer::Curves { label: label.to_owned(), curves }).collect(),
    }
}

/// Orbits that begin with slow turns to both sides, forward and backward, at fractions of the speed that has the energy of the start.
fn orbits(scene: &Scene, method: &Method, built: &BuiltScene) -> Vec<Vec<[f64; 2]>> {
    let (system, sleigh) = (built.system(), &scene.sleigh);
    let (Some(blade), mechanism) = (system.sleigh(), system.mechanism()) else { return Vec::new() };
    let start = blade.sleigh_state(&built.q, &built.v);
    let energy = sleigh.mass() * start.speed * start.speed + sleigh.pivot_inertia() * start.turn_rate * start.turn_rate;
    let speed = (energy / sleigh.mass()).sqrt();
    let (levels, turn) = PORTRAIT;
    let mut orbits = Vec::new();
    for level in levels.into_iter().flat_map(|level| [level, -level]) {
        for turn in [turn, -turn] {
            let mut xi = vec![level * speed, level.abs() * turn * speed];
            xi.resize(built.q.len(), 0.0);
            let Ok(v) = mechanism.velocity_of(0.0, &built.q, &xi) else { continue };
            let mut nodes = Trajectory::every(1);
            let mut state = mechanism.state(&built.q, &v);
            // An orbit that fails is shown as far as it goes.
            let _ = Run::of(&*mechanism, method).observe(&mut nodes).moves(&scene.schedule(), &mut state);
            let seen = nodes.nodes().iter().map(|node| blade.sleigh_state(&node.q, &node.v));
            orbits.push(seen.map(|state| [state.speed, state.turn_rate]).collect());
        }
    }
    orbits
}

/// A steady motion in the words of its scene, and how stable it is, of the flow and of a method.
struct SteadyMotion {
    /// The fields of the scene, and the lines for a person.
    fields: Value,
    lines: Vec<(&'static str, String)>,
    /// Number of parameters of the family of steady motions around this one.
    family: usize,
    stable: bool,
    /// The eigenvalues of the flow (1/s), real and imaginary part.
    flow: Vec<[f64; 2]>,
    /// The eigenvalues of a step of the method.
    map: Result<Vec<[f64; 2]>, MapError>,
    /// The longest step; `None` if the flow is unstable.
    limit: Option<StepLimit>,
}

/// What the eigenvalues of the flow say of a motion. More of them vanish than the motion has parameters where the motion may drift: these
/// say nothing.
fn stability(stable: bool, family: usize, flow: &[[f64; 2]]) -> &'static str {
    /// A double eigenvalue of zero and its rounding, relative to the largest.
    const ZERO: f64 = 1e-7;
    let sizes = || flow.iter().map(|[re, im]| re.hypot(*im));
    let zero = ZERO * sizes().fold(1.0, f64::max);
    match stable {
        false => "unstable",
        true if sizes().filter(|size| *size <= zero).count() > family => "neutral: eigenvalues that vanish do not tell",
        true => "stable",
    }
}

/// The names of the coordinates of a sleigh.
const COORDINATES: [&str; 4] = ["x", "y", "heading", "rotor"];

impl SteadyMotion {
    /// A steady motion of a system, and of steps of `h` (s) by a method.
    fn of(system: &Built<'_>, e: &Equilibrium, map: &DiscreteMap<'_>, h: f64) -> Self {
        let (fields, lines) = match system {
            Built::Sleigh(sleigh) => of_sleigh(*sleigh, e),
            Built::Text(text) => of_text(text.model().coordinates(), e),
        };
        let (family, stable, flow) = (e.family, e.stable, e.flow.clone());
        Self { fields, lines, family, stable, flow, map: map.spectrum(h, e), limit: stable.then(|| map.limit(h, e)) }
    }

    /// For a program.
    fn object(self) -> Value {
        let Self { fields: mut object, family, stable, flow, map, limit, .. } = self;
        object["family"] = json!(family);
        object["stable"] = json!(stable);
        object["flow"] = complex_json(&flow);
        object["map"] = json!(map.as_deref().ok().map(complex_json));
        object["map_failure"] = json!(map.as_ref().err().map(MapError::to_string));
        object["step_limit"] = json!(limit.and_then(StepLimit::step));
        object["step_limit_reason"] = json!(limit.map(StepLimit::reason));
        object["stable_up_to"] = json!(limit.and_then(StepLimit::stable_up_to));
        object
    }

    /// For a person.
    fn told(self) -> String {
        let Self { mut lines, family, stable, flow, map, limit, .. } = self;
        lines.extend([
            ("", stability(stable, family, &flow).to_owned()),
            ("parameters", family.to_string()),
            ("flow [1/s]", complex_numbers(&flow)),
            ("map", map.as_deref().map_or_else(MapError::to_string, complex_numbers)),
            ("longest step", limit_told(limit)),
        ]);
        format!("\n{}", table::aligned(&lines))
    }
}

fn of_sleigh(system: &dyn SceneSystem, e: &Equilibrium) -> (Value, Vec<(&'static str, String)>) {
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
    let fields = json!({
        "speed": speed, "turn_rate": turn_rate, "rotor_rate": rotor_rate, "x": x, "y": y, "heading": heading,
        "depends_on": depends_on,
    });
    (fields, vec![("motion", what)])
}

/// The rates by their names, and the coordinates on which the equations depend, with their values.
fn of_text(coordinates: &[Coordinate], e: &Equilibrium) -> (Value, Vec<(&'static str, String)>) {
    let rates: Vec<_> = coordinates.iter().zip(&e.v).map(|(of, rate)| (format!("{}'", of.name), *rate)).collect();
    let place = e.place.iter().filter_map(|&i| Some((coordinates.get(i)?.name.clone(), e.q[i])));
    let place: Vec<(String, f64)> = place.collect();
    let object =
        |of: &[(String, f64)]| -> Value { of.iter().map(|(name, value)| (name.clone(), json!(value))).collect() };
    let told = |of: &[(String, f64)]| {
        of.iter().map(|(name, value)| format!("{name} = {}", table::number(*value))).collect::<Vec<_>>().join(", ")
    };
    let fields = json!({"rates": object(&rates), "depends_on": object(&place)});
    let place = if place.is_empty() { "any".to_owned() } else { told(&place) };
    (fields, vec![("motion", told(&rates)), ("place", place)])
}

/// The extent of the search, for a person: the number of places and of velocities, and the largest distance from the start in a coordinate
/// (m or rad).
fn searched(places: usize, reach: f64, motions: usize) -> String {
    let places = match places {
        1 => "from the start".to_owned(),
        _ => format!("from {places} places up to {} from the start in each coordinate", table::number(reach)),
    };
    let velocities = if motions == 1 { "velocity" } else { "velocities" };
    let sentence = format!(
        "searched: rest {places}, steady motions from {motions} {velocities}; of a family one is shown, and there may \
            be others further away"
    );
    format!("\n{}", table::wrapped(&sentence))
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
fn complex_json(values: &[[f64; 2]]) -> Value {
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
