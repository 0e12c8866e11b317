use crate::args::EquilibriaArguments;
use crate::error::CliError;
use crate::file_roles::FileRoles;
use crate::files::{check_file, write_whole};
use crate::steady::{self, Stability, SteadyMotion};
use crate::{inspect, notes, terminal};
use dla::{Schedule, State, Trajectory};
use harness::analysis::{DiscreteMap, Equilibrium, EquilibriumError, differentiable, relative_equilibria};
use harness::report::{Chart, Layer, chart_svg};
use harness::{Method, integrate_pieces};
use scene::{AnyScene, Built, SceneSystem, Visitor};
use sleigh::Sleigh;

/// The speeds at which orbits of the phase portrait begin, relative to that of the scene's energy, and their turn rates,
/// relative to its turn rate.
const PORTRAIT: ([f64; 3], f64) = ([0.4, 0.7, 1.0], 0.03);

/// What was found, and the orbits of a picture of it.
struct FoundMotions {
    rows: Vec<MotionRow>,
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
    if differentiable::<3, 1>(&method).is_none() {
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
    let found = scene.visit(Find { scene: &scene, method: &method, portrait: arguments.picture.is_some() })??;
    if let Some(path) = &arguments.picture {
        let picture = chart_svg(&portrait(&scene, &found)).map_err(CliError::Report)?;
        write_whole(path, arguments.scene.force, |file| std::io::Write::write_all(file, picture.as_bytes()))?;
    }
    let (step, rows) = (scene.run().actual_step(), found.rows);
    if arguments.scene.json {
        let motions = rows.into_iter().map(|row| row.stability.object(row.motion.fields));
        terminal::print_json(&steady::object(scene.name(), &method, step, motions))
    } else {
        let heading = steady::heading((scene.title(), scene.name()), &method, step);
        let motions = rows.into_iter().map(|row| row.stability.lines(row.motion.lines));
        terminal::print(&std::iter::once(heading).chain(motions).collect::<String>())
    }
}

struct Find<'a> {
    scene: &'a AnyScene,
    method: &'a Method,
    portrait: bool,
}

impl Visitor for Find<'_> {
    type Output = Result<FoundMotions, CliError>;

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Self::Output {
        let Self { scene, method, portrait } = self;
        if !system.jump_times(0.0, scene.run().duration).is_empty() {
            return Err(EquilibriumError::TimeDependent.into());
        }
        let Some(steps) = differentiable::<N, M>(method) else {
            return Err(CliError::NotDifferentiated { method: method.info().name });
        };
        let (n, m) = system.own();
        if n == m {
            return Err(EquilibriumError::NothingFree.into());
        }
        let found = relative_equilibria(&*system, &q, &v)?;
        let h = scene.run().actual_step();
        let mut step = |step: f64, start: &State<N>| {
            let (mut end, schedule) = (*start, Schedule { t0: 0.0, step, steps: 1 });
            integrate_pieces(&system, method, &schedule, &mut end, &mut ()).ok().map(|_| end)
        };
        let mut map = DiscreteMap::new(&*system, &*steps, &mut step);
        // Coordinates that fill up the shape, and that no constraint holds, go on at any rate: eigenvalues of theirs are no news.
        let filling = (N - M) - (n - m);
        let mut row = |e: &Equilibrium<N>| MotionRow {
            motion: steady::motion(&system, e),
            rates: system.sleigh().map(|sleigh| sleigh.sleigh_state(&e.q, &e.v)).map(|at| [at.speed, at.turn_rate]),
            stability: Stability {
                family: e.family.saturating_sub(filling),
                stable: e.stable,
                map: map.spectrum(h, e).map(|values| without(values, [1.0, 0.0], filling)),
                limit: e.stable.then(|| map.limit(h, e)),
                flow: without(e.flow.clone(), [0.0, 0.0], filling),
            },
        };
        let rows = different(&found, if filling == 0 { N } else { n }).into_iter().map(&mut row).collect();
        let orbits = match (scene, system.sleigh()) {
            (AnyScene::Sleigh(scene), Some(blade)) if portrait => {
                let start = blade.sleigh_state(&q, &v);
                orbits((&system, blade), &scene.sleigh, [start.speed, start.turn_rate], method, &scene.schedule(), q)
            }
            _ => Vec::new(),
        };
        Ok(FoundMotions { rows, orbits })
    }
}

/// Those that differ in more than what fills up the shape, which has `n` coordinates of its own.
fn different<const N: usize>(found: &[Equilibrium<N>], n: usize) -> Vec<&Equilibrium<N>> {
    if n == N {
        return found.iter().collect();
    }
    let own = |e: &Equilibrium<N>| e.v[..n].iter().chain(&e.q[..n]).copied().collect::<Vec<_>>();
    let same =
        |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-8 * (1.0 + a.abs().max(b.abs())));
    let mut kept: Vec<&Equilibrium<N>> = Vec::new();
    for e in found {
        if !kept.iter().any(|other| same(&own(other), &own(e))) {
            kept.push(e);
        }
    }
    kept
}

/// The eigenvalues without so many that are nearest to a known one.
fn without(mut values: Vec<[f64; 2]>, known: [f64; 2], count: usize) -> Vec<[f64; 2]> {
    for _ in 0..count.min(values.len()) {
        let far = |[re, im]: &[f64; 2]| f64::hypot(re - known[0], im - known[1]);
        let nearest = values.iter().enumerate().min_by(|(_, a), (_, b)| far(a).total_cmp(&far(b)));
        if let Some((k, _)) = nearest {
            values.remove(k);
        }
    }
    values
}

/// Orbits from both sides of slow turns, at some speeds forward and back, of the energy of that speed and turn rate.
fn orbits<const N: usize, const M: usize>(
    (system, blade): (&Built<'_, N, M>, &dyn SceneSystem<N, M>),
    sleigh: &Sleigh,
    [speed, turn_rate]: [f64; 2],
    method: &Method,
    schedule: &Schedule,
    q: [f64; N],
) -> Vec<Vec<[f64; 2]>> {
    let energy = sleigh.mass() * speed * speed + sleigh.pivot_inertia() * turn_rate * turn_rate;
    let speed = (energy / sleigh.mass()).sqrt();
    let (levels, turn) = PORTRAIT;
    let mut orbits = Vec::new();
    for level in levels.into_iter().flat_map(|level| [level, -level]) {
        for turn in [turn, -turn] {
            let xi =
                std::array::from_fn(|k| [level * speed, level.abs() * turn * speed].get(k).copied().unwrap_or(0.0));
            let Ok(v) = system.velocity_of(0.0, &q, &xi) else { continue };
            let mut nodes = Trajectory::<N, M>::every(1);
            // An orbit that fails is shown as far as it goes.
            let _ = integrate_pieces(system, method, schedule, &mut State::new(q, v, system.angles()), &mut nodes);
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
