use crate::args::CompareArguments;
use crate::error::{CliError, unless_interrupted};
use crate::files::ClaimedFolder;
use crate::in_memory::MOST_NUMBERS;
use crate::interrupt::Interrupt;
use crate::progress::Interruptible;
use crate::resume::Saves;
use crate::table::ComparisonRow;
use crate::{account, facts, inspect, json, progress, table, terminal, train};
use dla::{AnyState, Schedule};
use harness::{Drift, DriftVerdict, Method, Progress, Record, Request, Run};
use report::{Body, HEADINGS, Report, SceneReport, Series};
use scene::{AnyScene, Built};
use sleigh::Exact;
use std::path::PathBuf;

/// A comparison of more steps, of a train times its coordinates, has no computed reference, which would take longer than all of it.
const REFERRED: u64 = 1 << 22;
/// The message if a signal came after all methods.
const WITHOUT_REFERENCE: &str = "all methods finished, the reference of their ends did not: there are no end errors";

/// A comparison on one scene: the runs, method by method, with what the closed form says of them.
pub(crate) struct Comparison {
    pub(crate) rows: Vec<ComparisonRow>,
    pub(crate) report: SceneReport,
    /// How far it came, if Ctrl-C ended it.
    pub(crate) interrupted: Option<String>,
}

/// `noslip compare`: long-run constraint and energy, method by method.
pub(crate) fn compare(arguments: &CompareArguments) -> Result<(), CliError> {
    let scene = inspect::load(&arguments.scene, None)?;
    let names = inspect::listed(arguments.methods.as_deref());
    let methods = inspect::methods(&names, scene.run().alpha, scene.run().tolerance)?;
    if let Some((_, name)) = names.iter().enumerate().find(|(k, name)| names[..*k].contains(*name)) {
        let problem = format!("--methods: `{name}` is named twice; a comparison has one row for each method");
        return Err(CliError::Request(problem));
    }
    let claimed = |folder: &PathBuf| ClaimedFolder::new(folder, arguments.scene.force);
    let folder = arguments.report.as_ref().map(claimed).transpose()?;

    let saves = Saves::of(arguments)?;
    let mut comparison = compare_scene(&scene, &methods, &saves, &Interrupt::listen())?;
    if let Some(folder) = &folder {
        let report = Report {
            title: format!("noslip compare {}", scene.name()),
            intro: table::INTRO.to_owned(),
            scenes: vec![std::mem::take(&mut comparison.report)],
            ..Report::default()
        };
        report::write(&report, folder.path()).map_err(CliError::Report)?;
    }
    if arguments.scene.json {
        let rows: Vec<_> = comparison.rows.iter().map(|row| &row.json).collect();
        let object = json::comparison(scene.name(), &rows, comparison.interrupted.is_some());
        terminal::print_json(&object)?;
    } else {
        terminal::print(&comparison.table(&scene, arguments.wide))?;
        if let Some(folder) = &arguments.report {
            terminal::print(&format!("report: {}\n", folder.join("index.html").display()))?;
        }
    }
    let named = arguments.methods.is_some();
    let failed = CliError::of_failures(
        comparison.rows.into_iter().filter_map(|row| if named { row.failure } else { row.unexpected() }),
    );
    let resume = saves.folder().map(ToOwned::to_owned);
    unless_interrupted(comparison.interrupted, resume, failed)
}

/// Runs every method on the scene, until Ctrl-C.
pub(crate) fn compare_scene(
    scene: &AnyScene,
    methods: &[Method],
    saves: &Saves,
    interrupt: &Interrupt,
) -> Result<Comparison, CliError> {
    inspect::moves(scene);
    let built = scene.built()?;
    let (system, q, v) = (&built.system(), &built.q, &built.v);
    let samples = (MOST_NUMBERS / 32 / q.len().max(1) as u64).clamp(2, 1000);
    let request = Request { schedule: scene.schedule(), q: q.clone(), v: v.clone(), samples };
    let (schedule, mut records) = (&request.schedule, Vec::new());
    for method in methods {
        if interrupt.asked() {
            break;
        }
        let label = format!("{} {}", scene.name(), method.info().name);
        records.push(progress::shown(&label, schedule.steps, interrupt, |progress| {
            saves.run(scene, &*system.mechanism(), method, &request, progress)
        })?);
    }
    let exact = exact(scene);
    let start = system.mechanism().state(q, v);
    let label = format!("{} reference", scene.name());
    let reference = progress::shown(&label, 4 * schedule.steps, interrupt, |progress| {
        ComparisonReference::of(system, exact.as_ref(), schedule, start, progress)
    });
    let referred = !matches!(reference, ComparisonReference::Interrupted);
    let drifts: Vec<(&str, Drift)> =
        records.iter().filter(|r| r.is_whole()).map(|r| (r.method.name, r.energy.drift)).collect();
    let (mut rows, mut series) = (Vec::new(), Vec::new());
    for record in &records {
        inspect::warn(record);
        let whole = Some(record).filter(|record| record.is_whole());
        let there = whole.and_then(|record| reference.at(record.t));
        let error = there.map(|end| system.distance(&record.q, &end));
        // The methods whose energy error starts smaller and becomes larger, each with the length of run (s) from which it is so.
        let better_than = |record: &Record| -> Vec<(&str, f64)> {
            let from = |other: &Drift| record.energy.drift.better_from(other);
            drifts.iter().filter_map(|(name, other)| Some((*name, from(other)?))).collect()
        };
        let better = whole.map_or_else(Vec::new, better_than);
        rows.push(ComparisonRow {
            cells: table::cells(record, error),
            json: json::compared_of(scene.name(), record, &account::state(system, record), error, &better),
            better: table::better(record, &better),
            failure: table::failure(record),
            refused: record.refusal().is_some(),
        });
        series.push(series_of(system, record));
    }
    // The longest run: a failed run ends before the rest.
    let times = series.iter().map(|series| &series.time).max_by_key(|time| time.len()).cloned().unwrap_or_default();
    let exact_path = exact.map(|exact| times.iter().map(|t| exact.at(*t)).map(|s| [s.x, s.y]).collect());
    let (whole, all) = (records.iter().filter(|record| !record.interrupted).count(), methods.len());
    let interrupted = if whole < all {
        let part = records.iter().find(|record| record.interrupted);
        let part = part.map(|record| format!(", {} up to t = {} s", record.method.name, table::number(record.t)));
        Some(format!("{whole} of {all} methods finished{}", part.unwrap_or_default()))
    } else {
        (!referred).then(|| WITHOUT_REFERENCE.to_owned())
    };
    let objects: Vec<_> = rows.iter().map(|row| &row.json).collect();
    let report = SceneReport {
        name: scene.name().to_owned(),
        title: scene.title().to_owned(),
        body: if system.sleigh().is_some() { Body::Sleigh } else { Body::Other },
        facts: facts::of(scene)?,
        columns: table::headings().map(str::to_owned).to_vec(),
        rows: rows.iter().map(|row| row.cells.clone()).collect(),
        series,
        exact_path,
        numbers: json::files(scene, &objects, interrupted.as_deref()),
        ..SceneReport::default()
    };
    Ok(Comparison { rows, report, interrupted })
}

impl Comparison {
    /// Its table; all columns if it may be `wide`.
    pub(crate) fn table(&self, scene: &AnyScene, wide: bool) -> String {
        table::comparison(scene, &self.rows, self.interrupted.as_deref(), wide)
    }
}

/// The closed-form motion of a scene; `None` if it has none.
pub(crate) fn exact(scene: &AnyScene) -> Option<Exact> {
    match scene {
        AnyScene::Sleigh(scene) => scene.exact().ok().flatten(),
        AnyScene::Text(_) => None,
    }
}

/// The configuration of a sleigh at time `t` (s) in closed form, without rotor angles.
pub(crate) fn place_at(exact: &Exact, t: f64) -> Vec<f64> {
    exact.at(t).to_coordinates().0.to_vec()
}

/// Reference for the end of the motion: the closed form, or `gauss16` with a quarter of the step.
enum ComparisonReference<'a> {
    Exact(&'a Exact),
    Computed {
        t: f64,
        end: Vec<f64>,
    },
    None,
    /// Ctrl-C ended the computation of the reference.
    Interrupted,
}

impl<'a> ComparisonReference<'a> {
    fn of(
        system: &Built<'_>,
        exact: Option<&'a Exact>,
        schedule: &Schedule,
        mut state: AnyState,
        progress: &mut Interruptible<'_>,
    ) -> Self {
        if let Some(exact) = exact {
            return Self::Exact(exact);
        }
        // Of an assembly by the best method that it has, and steps count by its coordinates.
        let (best, size) = if system.is_assembly() { ("dla8", state.q().len() as u64) } else { ("gauss16", 1) };
        if schedule.steps.saturating_mul(size) > REFERRED {
            return Self::None;
        }
        if progress.stops() {
            return Self::Interrupted;
        }
        let Ok(method) = Method::named(best, None) else { return Self::None };
        let fine = Schedule { step: 0.25 * schedule.step, steps: 4 * schedule.steps, ..*schedule };
        match Run::of(&*system.mechanism(), &method).progress(progress).moves(&fine, &mut state) {
            Ok(made) if made < fine.steps => Self::Interrupted,
            Ok(made) => Self::Computed { t: fine.time(made), end: state.unwrapped() },
            Err(_) => Self::None,
        }
    }

    /// The configuration at the time `t`, the end of a run.
    fn at(&self, time: f64) -> Option<Vec<f64>> {
        match self {
            Self::Exact(exact) => Some(place_at(exact, time)),
            Self::Computed { t, end } if (t - time).abs() <= 1e-9 * t.abs() => Some(end.clone()),
            Self::Computed { .. } | Self::None | Self::Interrupted => None,
        }
    }
}

/// The curves of a record: the path if there are coordinates `x` and `y`, the heading if an angle has one of the usual names, and the
/// rotor.
fn series_of(system: &Built<'_>, record: &Record) -> Series {
    // A run without a step has nothing to draw.
    let samples = if record.steps == 0 { &[][..] } else { &record.samples[..] };
    let column = |k: Option<usize>| -> Vec<f64> {
        let rest = vec![0.0; system.mechanism().size().n];
        let of = |k: usize| samples.iter().map(|sample| system.value(k, sample.t, &sample.q, &rest)).collect();
        k.map_or_else(Vec::new, of)
    };
    let path = system.named("x").zip(system.named("y"));
    let heading = path.and_then(|_| HEADINGS.into_iter().find_map(|name| system.named(name)));
    let [x, y] = [path.map(|(x, _)| x), path.map(|(_, y)| y)].map(column);
    Series {
        label: record.method.name.to_owned(),
        path: x.into_iter().zip(y).map(|(x, y)| [x, y]).collect(),
        heading: column(heading),
        rotor: column(system.named("rotor_angle")),
        followers: system.train().map_or_else(Vec::new, |train| train::followers_at(train, samples)),
        time: samples.iter().map(|sample| sample.t).collect(),
        constraint: samples.iter().map(|sample| sample.constraint).collect(),
        energy_error: samples.iter().map(|sample| sample.energy_error).collect(),
        failed: record.failure.is_some(),
        diverged: record.energy.drift.verdict == DriftVerdict::Diverged,
    }
}
