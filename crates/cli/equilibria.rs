use crate::args::EquilibriaArguments;
use crate::error::CliError;
use crate::file_roles::FileRoles;
use crate::files::{check_file, write_whole};
use crate::steady::{self, Searched, Stability, SteadyMotion};
use crate::{inspect, notes, terminal};
use dla::{Schedule, Trajectory};
use harness::analysis::{DiscreteMap, Equilibrium, EquilibriumError, has_map, relative_equilibria};
use harness::{Method, Run};
use report::{Chart, Layer, chart_svg};
use scene::{AnyScene, Built, SceneSystem};
use sleigh::Sleigh;

/// Starts of the phase portrait's orbits: speeds as fractions of the speed that has the scene's energy, and the turn rate as a fraction of
/// that speed (rad/m), both scaled alike.
const PORTRAIT: ([f64; 3], f64) = ([0.4, 0.7, 1.0], 0.03);

/// The motions found, and the orbits of a picture of them.
struct FoundMotions {
    rows: Vec<MotionRow>,
    searched: Searched,
    orbits: Vec<Vec<[f64; 2]>>,
}

/// A relative equilibrium in the words of a scene.
struct MotionRow {
    motion: SteadyMotion,
    /// Speed and turn rate, of a sleigh.
    rates: Option<[f64; 2]>,
    stability: Stability,
}

/// `noslip equilibria`: the steady motions of a scene, and how stable they are, of the flow and of a method.
pub(crate) fn equilibria(arguments: &EquilibriaArguments) -> Result<(), CliError> {
    let scene = inspect::load_any(&arguments.scene, arguments.method.as_deref())?;
    let method = inspect::method(scene.run())?;
    if !has_map(&method) {
        return Err(CliError::NotDifferentiated { method: method.info().name });
    }
    if let Some(path) = &arguments.picture {
        if matches!(scene, AnyScene::Text(_)) {
            let problem = "--picture draws the speed and the turn rate of a sleigh; the scene is a system of text";
            return Err(CliError::Request(problem.to_owned()));
        }
        FileRoles::of(&arguments.scene.scene).writes("--picture", Some(path)).check()?;
        check_file(path, arguments.scene.force)?;
    }
    notes::moves(&scene);
    let built = scene.built_for_analysis()?;
    let find = Find { scene: &scene, method: &method, portrait: arguments.picture.is_some() };
    let found = find.on(&built.system(), (&built.q, &built.v))?;
    if let Some(path) = &arguments.picture {
        let picture = chart_svg(&portrait(&scene, &found));
        write_whole(path, arguments.scene.force, |file| std::io::Write::write_all(file, picture.as_bytes()))?;
    }
    let (step, rows, searched) = (scene.run().actual_step(), found.rows, found.searched);
    if arguments.scene.json {
        let motions = rows.into_iter().map(|row| row.stability.object(row.motion.fields));
        terminal::print_json(&steady::object(scene.name(), &method, step, (motions, &searched)))
    } else {
        let heading = steady::heading((scene.title(), scene.name()), &method, step);
        let motions = rows.into_iter().map(|row| row.stability.lines(row.motion.lines));
        terminal::print(&std::iter::once(heading).chain(motions).chain([searched.told()]).collect::<String>())
    }
}

struct Find<'a> {
    scene: &'a AnyScene,
    method: &'a Method,
    portrait: bool,
}

impl Find<'_> {
    fn on(self, system: &Built<'_>, (q, v): (&[f64], &[f64])) -> Result<FoundMotions, CliError> {
        let Self { scene, method, portrait } = self;
        let mechanism = system.mechanism();
        if !mechanism.jump_times(0.0, scene.run().duration).is_empty() {
            return Err(EquilibriumError::TimeDependent.into());
        }
        let own = system.own();
        let all = relative_equilibria(&*mechanism, own, q, v)?;
        let h = scene.run().actual_step();
        let map = DiscreteMap::new(&*mechanism, own, method);
        let mut row = |e: &Equilibrium| MotionRow {
            motion: steady::motion(system, e),
            rates: system.sleigh().map(|sleigh| sleigh.sleigh_state(&e.q, &e.v)).map(|at| [at.speed, at.turn_rate]),
            stability: Stability {
                family: e.family,
                stable: e.stable,
                map: map.spectrum(h, e),
                limit: e.stable.then(|| map.limit(h, e)),
                flow: e.flow.clone(),
            },
        };
        let rows = all.found.iter().map(&mut row).collect();
        let searched = Searched { places: all.places, reach: all.reach, motions: all.motions };
        let orbits = match (scene, system.sleigh()) {
            (AnyScene::Sleigh(scene), Some(blade)) if portrait => {
                let start = blade.sleigh_state(q, v);
                orbits((system, blade), &scene.sleigh, [start.speed, start.turn_rate], method, &scene.schedule(), q)
            }
            _ => Vec::new(),
        };
        Ok(FoundMotions { rows, searched, orbits })
    }
}

/// Orbits that begin with slow turns to both sides, forward and backward, at fractions of the speed that has the energy of `speed` and
/// `turn_rate`.
fn orbits(
    (system, blade): (&Built<'_>, &dyn SceneSystem),
    sleigh: &Sleigh,
    [speed, turn_rate]: [f64; 2],
    method: &Method,
    schedule: &Schedule,
    q: &[f64],
) -> Vec<Vec<[f64; 2]>> {
    let mechanism = system.mechanism();
    let energy = sleigh.mass() * speed * speed + sleigh.pivot_inertia() * turn_rate * turn_rate;
    let speed = (energy / sleigh.mass()).sqrt();
    let (levels, turn) = PORTRAIT;
    let mut orbits = Vec::new();
    for level in levels.into_iter().flat_map(|level| [level, -level]) {
        for turn in [turn, -turn] {
            let mut xi = vec![level * speed, level.abs() * turn * speed];
            xi.resize(q.len(), 0.0);
            let Ok(v) = mechanism.velocity_of(0.0, q, &xi) else { continue };
            let mut nodes = Trajectory::every(1);
            // An orbit that fails is shown as far as it goes.
            let run = Run::of(&*mechanism, method).observe(&mut nodes);
            let _ = run.moves(schedule, &mut mechanism.state(q, &v));
            let seen = nodes.nodes().iter().map(|node| blade.sleigh_state(&node.q, &node.v));
            orbits.push(seen.map(|state| [state.speed, state.turn_rate]).collect());
        }
    }
    orbits
}

fn portrait(scene: &AnyScene, found: &FoundMotions) -> Chart {
    let steady = |stable: bool| {
        let rows = found.rows.iter().filter(|row| row.stability.stable == stable);
        rows.filter_map(|row| Some(vec![row.rates?])).collect()
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
        title: format!("{}: phase portrait", scene.title()),
        axes: ["speed [m/s]".to_owned(), "turn rate [rad/s]".to_owned()],
        decades: [false; 2],
        layers: kinds.map(|(label, curves)| Layer::Curves { label: label.to_owned(), curves }).collect(),
    }
}
