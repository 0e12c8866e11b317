use crate::args::CompareArguments;
use crate::error::CliError;
use crate::{facts, inspect, json, progress, table, terminal};
use dla::{Schedule, State};
use harness::report::{self, Report, SceneReport, Series};
use harness::{METHODS, Method, Record, Request};
use scene::{Scene, SceneSystem, Visitor};
use serde_json::json;
use sleigh::{Exact, SleighState};

/// A comparison on one scene: the runs, method by method, with what the closed form says of them.
pub(crate) struct Comparison {
    pub(crate) rows: Vec<Row>,
    pub(crate) report: SceneReport,
}

/// One method's run, the number of coordinates forgotten.
pub(crate) struct Row {
    pub(crate) cells: Vec<String>,
    pub(crate) json: serde_json::Value,
    pub(crate) failure: Option<String>,
    /// The method refuses the scene.
    pub(crate) refused: bool,
}

impl Row {
    /// The failure, unless all that happened is that a method which nobody asked for by name refuses the scene.
    pub(crate) fn unexpected(self) -> Option<String> {
        self.failure.filter(|_| !self.refused)
    }
}

/// `noslip compare`: long-run constraint and energy, method by method.
pub(crate) fn compare(arguments: &CompareArguments) -> Result<(), CliError> {
    let scene = inspect::load(&arguments.scene, None)?;
    let names: Vec<&str> = match &arguments.methods {
        Some(names) => names.iter().map(|name| name.trim()).collect(),
        None => METHODS.iter().map(|info| info.name).collect(),
    };
    let methods = methods(&names, scene.run.alpha)?;
    if let Some(folder) = &arguments.report {
        crate::files::check_folder(folder, arguments.scene.force)?;
    }

    let comparison = compare_scene(&scene, &methods)?;
    if let Some(folder) = &arguments.report {
        let report = Report {
            title: format!("noslip compare {}", scene.name),
            intro: table::INTRO.to_owned(),
            scenes: vec![comparison.report],
        };
        report::write(&report, folder, arguments.scene.force).map_err(CliError::Report)?;
    }
    if arguments.scene.json {
        let rows: Vec<_> = comparison.rows.iter().map(|row| row.json.clone()).collect();
        terminal::print_json(&json!({"scene": scene.name, "rows": rows}))?;
    } else {
        terminal::print(&table::comparison(&scene, &comparison.rows))?;
        if let Some(folder) = &arguments.report {
            terminal::print(&format!("report: {}\n", folder.join("index.html").display()))?;
        }
    }
    let named = arguments.methods.is_some();
    CliError::of_failures(
        comparison.rows.into_iter().filter_map(|row| if named { row.failure } else { row.unexpected() }),
    )
}

pub(crate) fn methods(names: &[&str], alpha: Option<f64>) -> Result<Vec<Method>, CliError> {
    Ok(names.iter().map(|name| Method::named(name, alpha)).collect::<Result<_, _>>()?)
}

/// Runs every method on the scene.
pub(crate) fn compare_scene(scene: &Scene, methods: &[Method]) -> Result<Comparison, CliError> {
    Ok(scene.visit(Compare { scene, methods })?)
}

struct Compare<'a> {
    scene: &'a Scene,
    methods: &'a [Method],
}

impl Visitor for Compare<'_> {
    type Output = Comparison;

    fn visit<Sys, const N: usize, const M: usize>(self, system: &Sys, q: [f64; N], v: [f64; N]) -> Comparison
    where
        Sys: SceneSystem<N, M>,
    {
        let schedule = inspect::schedule(self.scene);
        let exact = self.scene.exact().ok().flatten();
        let reference = Reference::of(system, exact.as_ref(), &schedule, State::new(q, v, system.angles()));
        let (mut rows, mut series) = (Vec::new(), Vec::new());
        for method in self.methods {
            let bar = progress::bar(&format!("{} {}", self.scene.name, method.info().name), schedule.steps);
            let request = Request { schedule, q, v, samples: 1000 };
            let record = harness::run(system, method, &request, &mut |steps| bar.inc(steps));
            bar.finish_and_clear();
            let end = system.sleigh_state(&record.q, &record.v);
            let error = reference.at(system, record.t).map(|reference| distance(&end, &reference));
            rows.push(Row {
                cells: table::cells(&record, error),
                json: json::compared(&self.scene.name, &record, &end, error),
                failure: table::failure(&record),
                refused: record.refusal().is_some(),
            });
            series.push(series_of(system, &record));
        }
        // The longest run: one that failed ends before the others.
        let times = series.iter().map(|series| &series.time).max_by_key(|time| time.len()).cloned().unwrap_or_default();
        let exact_path = exact.map(|exact| times.iter().map(|t| exact.at(*t)).map(|s| [s.x, s.y]).collect());
        let report = SceneReport {
            name: self.scene.name.clone(),
            title: self.scene.title.clone(),
            facts: facts::of(self.scene, system, &State::new(q, v, system.angles())),
            columns: table::COLUMNS.iter().map(|column| (*column).to_owned()).collect(),
            rows: rows.iter().map(|row| row.cells.clone()).collect(),
            series,
            exact_path,
        };
        Comparison { rows, report }
    }
}

/// Where the motion truly ends: in closed form, or by the method of the highest order with a quarter of the step.
enum Reference<'a, const N: usize> {
    Exact(&'a Exact),
    Computed { t: f64, state: State<N> },
    None,
}

impl<'a, const N: usize> Reference<'a, N> {
    fn of<Sys, const M: usize>(system: &Sys, exact: Option<&'a Exact>, schedule: &Schedule, mut state: State<N>) -> Self
    where
        Sys: SceneSystem<N, M>,
    {
        if let Some(exact) = exact {
            return Self::Exact(exact);
        }
        let Ok(method) = Method::named("gauss16", None) else { return Self::None };
        let fine = Schedule { step: 0.25 * schedule.step, steps: 4 * schedule.steps, ..*schedule };
        match harness::integrate_pieces(system, &method, &fine, &mut state, &mut ()) {
            Ok(made) => Self::Computed { t: fine.time(made), state },
            Err(_) => Self::None,
        }
    }

    /// The state at the time `t`, which is the end of the run unless the run failed.
    fn at<Sys, const M: usize>(&self, system: &Sys, t: f64) -> Option<SleighState>
    where
        Sys: SceneSystem<N, M>,
    {
        match self {
            Self::Exact(exact) => Some(exact.at(t)),
            Self::Computed { t: end, state } if (end - t).abs() <= 1e-9 * end.abs() => {
                Some(system.sleigh_state(&state.unwrapped(), state.v()))
            }
            Self::Computed { .. } | Self::None => None,
        }
    }
}

/// The larger of the distances in position [m] and in heading [rad].
pub(crate) fn distance(a: &SleighState, b: &SleighState) -> f64 {
    let (place, turn) = (f64::hypot(a.x - b.x, a.y - b.y), (a.heading - b.heading).abs());
    if place > turn || place.is_nan() { place } else { turn }
}

fn series_of<Sys, const N: usize, const M: usize>(system: &Sys, record: &Record<N>) -> Series
where
    Sys: SceneSystem<N, M>,
{
    // A run without a step has nothing to draw.
    let samples = if record.steps == 0 { &[][..] } else { &record.samples[..] };
    let states: Vec<SleighState> = samples.iter().map(|sample| system.sleigh_state(&sample.q, &[0.0; N])).collect();
    Series {
        label: record.method.name.to_owned(),
        path: states.iter().map(|state| [state.x, state.y]).collect(),
        heading: states.iter().map(|state| state.heading).collect(),
        time: samples.iter().map(|sample| sample.t).collect(),
        constraint: samples.iter().map(|sample| sample.constraint).collect(),
        energy_error: samples.iter().map(|sample| sample.energy_error).collect(),
    }
}
