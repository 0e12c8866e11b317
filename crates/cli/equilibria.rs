use crate::args::EquilibriaArguments;
use crate::error::CliError;
use crate::files::{check_file, write_whole};
use crate::steady::{self, Stability};
use crate::{inspect, table, terminal, text};
use dla::{Schedule, State, Trajectory};
use harness::analysis::{DiscreteMap, EquilibriumError, differentiable, relative_equilibria};
use harness::report::{Chart, Layer, chart_svg};
use harness::{Method, integrate_pieces};
use scene::{AnyScene, Scene, SceneSystem, Visitor};
use serde_json::{Value, json};
use sleigh::SleighState;
use std::fmt::Write;

/// The names of the coordinates.
const COORDINATES: [&str; 4] = ["x", "y", "heading", "rotor"];
/// The speeds at which orbits of the phase portrait begin, relative to that of the scene's energy, and their turn rates,
/// relative to its turn rate.
const PORTRAIT: ([f64; 3], f64) = ([0.4, 0.7, 1.0], 0.03);

/// What was found, and the orbits of a picture of it.
struct Found {
    rows: Vec<Row>,
    orbits: Vec<Vec<[f64; 2]>>,
}

/// A relative equilibrium in the words of a scene.
struct Row {
    state: SleighState,
    rotor_rate: Option<f64>,
    depends_on: Vec<&'static str>,
    stability: Stability,
}

/// `noslip equilibria`: the steady motions of a scene, and how stable they are, of the flow and of a method.
pub(crate) fn equilibria(arguments: &EquilibriaArguments) -> Result<(), CliError> {
    let scene = match inspect::load_any(&arguments.scene, arguments.method.as_deref())? {
        AnyScene::Sleigh(scene) => *scene,
        AnyScene::Text(scene) => return text::equilibria::equilibria(arguments, &scene),
    };
    let method = Method::named(&scene.run.method, scene.run.alpha)?;
    if differentiable::<3, 1>(&method).is_none() {
        return Err(CliError::NotDifferentiated { method: method.info().name });
    }
    if let Some(path) = &arguments.picture {
        check_file(path, arguments.scene.force)?;
    }
    let found = scene.visit(Find { scene: &scene, method: &method, portrait: arguments.picture.is_some() })??;
    if let Some(path) = &arguments.picture {
        let picture = chart_svg(&portrait(&scene, &found)).map_err(CliError::Report)?;
        write_whole(path, arguments.scene.force, |file| std::io::Write::write_all(file, picture.as_bytes()))?;
    }
    if arguments.scene.json {
        terminal::print_json(&object(&scene, &method, &found.rows))
    } else {
        terminal::print(&told(&scene, &method, &found.rows))
    }
}

struct Find<'a> {
    scene: &'a Scene,
    method: &'a Method,
    portrait: bool,
}

impl Visitor for Find<'_> {
    type Output = Result<Found, CliError>;

    fn visit<const N: usize, const M: usize>(
        self,
        system: &dyn SceneSystem<N, M>,
        q: [f64; N],
        v: [f64; N],
    ) -> Self::Output {
        let Self { scene, method, portrait } = self;
        if !system.jump_times(0.0, scene.run.duration).is_empty() {
            return Err(EquilibriumError::TimeDependent.into());
        }
        let found = relative_equilibria(system, &q, &v)?;
        let Some(steps) = differentiable::<N, M>(method) else {
            return Err(CliError::NotDifferentiated { method: method.info().name });
        };
        let h = scene.run.actual_step();
        let mut step = |step: f64, start: &State<N>| {
            let (mut end, schedule) = (*start, Schedule { t0: 0.0, step, steps: 1 });
            integrate_pieces(&system, method, &schedule, &mut end, &mut ()).ok().map(|_| end)
        };
        let mut map = DiscreteMap::new(system, &*steps, &mut step);
        let row = |e: &harness::analysis::Equilibrium<N>| Row {
            state: system.sleigh_state(&e.q, &e.v),
            rotor_rate: system.rotor(&e.q, &e.v).map(|[_, rate]| rate),
            depends_on: e.shape.iter().filter_map(|i| COORDINATES.get(*i).copied()).collect(),
            stability: Stability {
                family: e.family,
                stable: e.stable,
                map: map.spectrum(h, e),
                limit: e.stable.then(|| map.limit(h, e)),
                flow: e.flow.clone(),
            },
        };
        let rows = found.iter().map(row).collect();
        let orbits = if portrait { orbits(system, scene, method, &q, &v) } else { Vec::new() };
        Ok(Found { rows, orbits })
    }
}

/// Orbits from both sides of slow turns, at some speeds forward and back.
fn orbits<const N: usize, const M: usize>(
    system: &dyn SceneSystem<N, M>,
    scene: &Scene,
    method: &Method,
    q: &[f64; N],
    v: &[f64; N],
) -> Vec<Vec<[f64; 2]>> {
    let start = system.sleigh_state(q, v);
    let sleigh = &scene.sleigh;
    let energy = sleigh.mass() * start.speed * start.speed + sleigh.pivot_inertia() * start.turn_rate * start.turn_rate;
    let speed = (energy / sleigh.mass()).sqrt();
    let schedule = inspect::schedule(scene);
    let (levels, turn) = PORTRAIT;
    let mut orbits = Vec::new();
    for level in levels.into_iter().flat_map(|level| [level, -level]) {
        for turn in [turn, -turn] {
            let xi =
                std::array::from_fn(|k| [level * speed, level.abs() * turn * speed].get(k).copied().unwrap_or(0.0));
            let Ok(v) = system.velocity_of(0.0, q, &xi) else { continue };
            let mut nodes = Trajectory::<N, M>::every(1);
            // An orbit that fails is shown as far as it goes.
            let _ = integrate_pieces(&system, method, &schedule, &mut State::new(*q, v, system.angles()), &mut nodes);
            let seen = nodes.nodes().iter().map(|node| system.sleigh_state(&node.q, &node.v));
            orbits.push(seen.map(|state| [state.speed, state.turn_rate]).collect());
        }
    }
    orbits
}

fn portrait(scene: &Scene, found: &Found) -> Chart {
    let steady = |stable: bool| {
        let rows = found.rows.iter().filter(|row| row.stability.stable == stable);
        rows.map(|row| vec![[row.state.speed, row.state.turn_rate]]).collect()
    };
    let starts = found.orbits.iter().filter_map(|orbit| orbit.first().map(|start| vec![*start])).collect();
    let kinds = [
        ("orbits", found.orbits.clone()),
        ("stable", steady(true)),
        ("unstable", steady(false)),
        ("where orbits begin", starts),
    ];
    let kinds = kinds.into_iter().filter(|(_, curves)| !curves.is_empty());
    Chart {
        title: format!("{}: phase portrait", scene.title),
        axes: ["speed [m/s]".to_owned(), "turn rate [rad/s]".to_owned()],
        decades: [false; 2],
        layers: kinds.map(|(label, curves)| Layer::Curves { label: label.to_owned(), curves }).collect(),
    }
}

fn object(scene: &Scene, method: &Method, rows: &[Row]) -> Value {
    let motion = |row: &Row| {
        let SleighState { x, y, heading, speed, turn_rate } = row.state;
        let fields = [
            ("speed", json!(speed)),
            ("turn_rate", json!(turn_rate)),
            ("rotor_rate", json!(row.rotor_rate)),
            ("x", json!(x)),
            ("y", json!(y)),
            ("heading", json!(heading)),
            ("depends_on", json!(row.depends_on)),
        ];
        row.stability.object(fields.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
    };
    steady::object(&scene.name, method, scene.run.actual_step(), rows.iter().map(motion))
}

fn told(scene: &Scene, method: &Method, rows: &[Row]) -> String {
    let motion = |row: &Row| {
        let mut what = format!("{} m/s, {} rad/s", table::number(row.state.speed), table::number(row.state.turn_rate));
        if let Some(rate) = row.rotor_rate {
            let _ = write!(what, ", rotor {} rad/s", table::number(rate));
        }
        if !row.depends_on.is_empty() {
            let SleighState { x, y, heading, .. } = row.state;
            let [x, y, heading] = [x, y, heading].map(table::number);
            let _ = write!(what, ", at x = {x} m, y = {y} m, heading {heading} rad");
        }
        row.stability.lines(vec![("motion", what)])
    };
    let heading = steady::heading((&scene.title, &scene.name), method, scene.run.actual_step());
    std::iter::once(heading).chain(rows.iter().map(motion)).collect()
}
