//! Scenes with trailers: assemblies, whose number of coordinates is not known to the compiler.

use crate::args::RunArguments;
use crate::compare::{Comparison, Row, better_than, distance, unless_interrupted};
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::precision::{KnownEnd, Measurement};
use crate::progress::Interruptible;
use crate::trajectory_file::{self, Columns, Format};
use crate::{compare_numbers, facts, inspect, json, progress, table, terminal};
use assembly::State;
use assembly::parts::Train;
use dla::{RunError, Schedule};
use harness::precision::{Bench, Limits, rounds, work_precision};
use harness::report::{SceneReport, Series};
use harness::{Assembled, AssemblyNode, Drift, Method, assembly_end, run_assembly};
use scene::Scene;
use serde_json::json;
use sleigh::SleighState;
use std::path::Path;
use std::time::{Duration, Instant};

/// So many numbers of a run are kept at most, for a file or a report.
const MOST_NUMBERS: u64 = 100_000_000;
/// A report shows so many blades of a train.
const SHOWN: usize = 60;
/// A comparison of more steps of blades has no computed reference.
const REFERRED: u64 = 1 << 22;

/// `noslip run` of a train.
pub(crate) fn run(
    arguments: &RunArguments,
    scene: &Scene,
    method: &Method,
    out: Option<(&Path, Format)>,
) -> Result<(), CliError> {
    let Some((train, start)) = scene.train()? else { return Ok(()) };
    let RunArguments { checkpoint, resume, tolerance, event, until, .. } = arguments;
    let asked = [
        ("--checkpoint", checkpoint.is_some()),
        ("--resume", resume.is_some()),
        ("--tolerance", tolerance.is_some()),
        ("--event", !event.is_empty()),
        ("--until", !until.is_empty()),
    ];
    if let Some((flag, _)) = asked.iter().find(|(_, asked)| *asked) {
        return Err(CliError::Request(format!("{flag} does not do scenes with `trailers`")));
    }
    let schedule = inspect::schedule(scene);
    let every = out.map_or(schedule.steps, |_| arguments.every);
    if schedule.steps / every.max(1) * 2 * start.len() as u64 > MOST_NUMBERS {
        let problem = "--out would hold more than 1e8 numbers: choose a larger --every";
        return Err(CliError::Request(problem.to_owned()));
    }
    let interrupt = Interrupt::listen();
    let bar = progress::bar(method.info().name, schedule.steps);
    let mut progress = Interruptible { bar, interrupt: &interrupt };
    let Assembled { record, nodes, end, failure } =
        run_assembly(&train.assembly, method, &schedule, &start, every, &mut progress);
    progress.bar.finish_and_clear();

    let written = out.map_or(Ok(()), |(path, format)| {
        trajectory_file::write_columns(&columns(&train, &nodes), path, format, arguments.scene.force)
    });
    let blades = train.trailers().len();
    let (first, last) = (train.blade(&end, 0), train.blade(&end, blades));
    if arguments.scene.json {
        let mut object = json::record(&scene.name, &record, &first);
        object["constraint"]["leaf_max"] = json!(record.leaf_max);
        object["trailers"] = json!(blades);
        let SleighState { x, y, heading, speed, turn_rate } = last;
        object["last"] = json!({"x": x, "y": y, "heading": heading, "speed": speed, "turn_rate": turn_rate});
        terminal::print_json(&object)?;
    } else {
        let file = out.and_then(|(path, _)| written.is_ok().then_some(path));
        let joints = format!("{:.2e} m at most", record.leaf_max.unwrap_or(0.0));
        let [x, y, heading] = [last.x, last.y, last.heading].map(table::number);
        let more = [
            ("hinges", joints),
            ("trailers", blades.to_string()),
            ("last blade", format!("x = {x} m, y = {y} m, heading {heading} rad")),
        ];
        terminal::print(&(table::one_run(scene, &record, &first, file) + &table::aligned(&more)))?;
    }
    // The static record does not know which hinge it was.
    let told = table::failure(&record).map(|told| match &failure {
        Some(error) if !told.contains(&error.to_string()) => format!("{told}; {error}"),
        _ => told,
    });
    let computed = CliError::of_failures(told);
    if let (Err(_), Err(error)) = (&computed, &written) {
        terminal::say("error", error);
    }
    let made = record.interrupted.then(|| format!("the run is made up to t = {} s", table::number(record.t)));
    unless_interrupted(made, None, computed.and(written))
}

/// A trajectory of a train: that of its first blade, and the headings of the others.
fn columns(train: &Train, nodes: &[AssemblyNode]) -> Columns {
    let own = [
        ("t", "s"),
        ("x", "m"),
        ("y", "m"),
        ("heading", "rad"),
        ("speed", "m/s"),
        ("turn_rate", "rad/s"),
        ("energy", "J"),
        ("work", "J"),
        ("constraint", "m/s"),
        ("hinges", "m"),
    ];
    let mut header: Vec<(String, &'static str)> = own.map(|(name, unit)| (name.to_owned(), unit)).to_vec();
    let trailers = 1..=train.trailers().len();
    header.extend(trailers.clone().map(|k| (format!("heading_{k}"), "rad")));
    let row = |node: &AssemblyNode| {
        let SleighState { x, y, heading, speed, turn_rate } = first(&node.q, &node.v);
        let AssemblyNode { t, energy, work, constraint, joint, .. } = *node;
        let mut row = vec![t, x, y, heading, speed, turn_rate, energy, work, constraint, joint];
        row.extend(trailers.clone().map(|k| node.q[3 * k + 2]));
        row
    };
    Columns::new(header, nodes.iter().map(row).collect())
}

/// The state of the first blade.
fn first(q: &[f64], v: &[f64]) -> SleighState {
    let of = |x: &[f64]| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
    SleighState::from_coordinates(&of(q), &of(v))
}

/// Runs every method on a train, until Ctrl-C.
pub(crate) fn compare_scene(
    scene: &Scene,
    (train, start): &(Train, State),
    methods: &[Method],
    interrupt: &Interrupt,
) -> Result<Comparison, CliError> {
    let (assembly, schedule) = (&train.assembly, inspect::schedule(scene));
    let samples = (MOST_NUMBERS / 32 / start.len() as u64).clamp(2, 1000);
    let every = schedule.steps.div_ceil(samples);
    let mut runs: Vec<Assembled> = Vec::new();
    for method in methods {
        if interrupt.asked() {
            break;
        }
        let bar = progress::bar(&format!("{} {}", scene.name, method.info().name), schedule.steps);
        let mut progress = Interruptible { bar, interrupt };
        runs.push(run_assembly(assembly, method, &schedule, start, every, &mut progress));
        progress.bar.finish_and_clear();
    }
    let reference = reference(scene, train, start, &schedule, interrupt);
    let drifts: Vec<(&str, Drift)> = runs.iter().map(|run| (run.record.method.name, run.record.energy.drift)).collect();
    let (mut rows, mut series) = (Vec::new(), Vec::new());
    for Assembled { record, nodes, end, .. } in &runs {
        let end = train.blade(end, 0);
        let whole = record.steps == schedule.steps;
        let error = reference.as_ref().filter(|_| whole).map(|state| distance(&end, &train.blade(state, 0)));
        let better = better_than(&record.energy.drift, &drifts);
        rows.push(Row {
            cells: table::cells(record, error),
            json: json::compared(&scene.name, record, &end, error, &better),
            better: table::better(record, &better),
            failure: table::failure(record),
            refused: record.refusal().is_some(),
        });
        let drawn = if record.steps == 0 { &[][..] } else { &nodes[..] };
        let sampled = |of: fn(&harness::Sample<3>) -> f64| record.samples.iter().take(drawn.len()).map(of).collect();
        series.push(Series {
            label: record.method.name.to_owned(),
            path: drawn.iter().map(|node| [node.q[0], node.q[1]]).collect(),
            heading: drawn.iter().map(|node| node.q[2]).collect(),
            followers: followers(train, drawn),
            time: drawn.iter().map(|node| node.t).collect(),
            constraint: sampled(|sample| sample.constraint),
            energy_error: sampled(|sample| sample.energy_error),
            ..Series::default()
        });
    }
    let whole = runs.iter().filter(|run| !run.record.interrupted).count();
    let interrupted = (whole < methods.len()).then(|| format!("{whole} of {} methods are done", methods.len()));
    let objects: Vec<_> = rows.iter().map(|row| &row.json).collect();
    let report = SceneReport {
        name: scene.name.clone(),
        title: scene.title.clone(),
        facts: facts::listed(scene, &scene.start, assembly.energy(0.0, start), ""),
        columns: table::COLUMNS.iter().map(|column| (*column).to_owned()).collect(),
        rows: rows.iter().map(|row| row.cells.clone()).collect(),
        series,
        exact_path: None,
        numbers: compare_numbers::files(&scene.name, &objects, interrupted.is_some()),
    };
    Ok(Comparison { rows, report, interrupted })
}

/// Where the motion ends by dla8 with a quarter of the step; none of a run that would take longer than all others.
fn reference(scene: &Scene, train: &Train, start: &State, schedule: &Schedule, interrupt: &Interrupt) -> Option<State> {
    if schedule.steps.saturating_mul(start.len() as u64) > REFERRED || interrupt.asked() {
        return None;
    }
    let method = Method::named("dla8", None).ok()?;
    let fine = Schedule { step: 0.25 * schedule.step, steps: 4 * schedule.steps, ..*schedule };
    let bar = progress::bar(&format!("{} reference", scene.name), fine.steps);
    let mut progress = Interruptible { bar, interrupt };
    let end = assembly_end(&train.assembly, &method, &fine, start, &mut progress);
    progress.bar.finish_and_clear();
    end.ok().flatten()
}

/// What accuracy costs on a train: error of the first blade at the end against the time of a run.
pub(crate) fn measure(
    scene: &Scene,
    (train, start): &(Train, State),
    methods: &[Method],
    longest: f64,
) -> Result<Measurement, CliError> {
    let (assembly, duration) = (&train.assembly, scene.run.duration);
    let end = |method: &Method, steps: u64| -> Result<SleighState, RunError> {
        let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
        match assembly_end(assembly, method, &schedule, start, &mut ()) {
            Ok(state) => Ok(train.blade(state.as_ref().unwrap_or(start), 0)),
            Err(error) => Err(RunError { step: error.step, time: error.time, source: error.source.step_error() }),
        }
    };
    let reference = converged(&end)?;
    let end_error = |method: &Method, steps: u64| end(method, steps).map(|state| distance(&state, &reference.end));
    let bench = Bench { duration, reference_error: reference.error, end_error: &end_error, aligned: &|steps| steps };
    let limits = Limits { fewest: 2, longest };
    let bar = progress::bar(&format!("{} precision", scene.name), methods.len() as u64 + rounds());
    let (curves, clock) = work_precision(&bench, methods, &limits, &mut |done| bar.inc(done));
    bar.finish_and_clear();
    let mut facts = facts::listed(scene, &scene.start, assembly.energy(0.0, start), "");
    // The steps are those of the ladders, not the scene's.
    facts.pop();
    Ok(Measurement { duration, reference, clock, facts, curves })
}

/// The end by `dla8`, its steps doubled until two successive ends are no nearer than those before, or it takes too long.
fn converged(end: &dyn Fn(&Method, u64) -> Result<SleighState, RunError>) -> Result<KnownEnd, CliError> {
    /// Of one run.
    const LONG: Duration = Duration::from_secs(10);
    const FEWEST: u64 = 32;
    let dla8 = Method::named("dla8", None)?;
    let mut best: Option<KnownEnd> = None;
    let (mut before, mut steps, mut failure) = (None, FEWEST, String::new());
    while steps <= FEWEST << 12 {
        let clock = Instant::now();
        match end(&dla8, steps) {
            Ok(state) => {
                let error = before.as_ref().map(|before| distance(before, &state));
                if let Some(error) = error {
                    if best.as_ref().is_some_and(|best| error >= best.error) {
                        break;
                    }
                    best = Some(KnownEnd { closed: false, by: "dla8", steps, error, end: state });
                }
                before = Some(state);
            }
            Err(error) => failure = error.to_string(),
        }
        if clock.elapsed() > LONG {
            break;
        }
        steps *= 2;
    }
    best.ok_or_else(|| CliError::Computation(vec![format!("the reference: too few runs of dla8 succeed: {failure}")]))
}

/// Places and headings of the trailers at every node, those that a report shows.
fn followers(train: &Train, nodes: &[AssemblyNode]) -> Vec<Vec<[f64; 3]>> {
    let shown = 1..=train.trailers().len().min(SHOWN);
    let blade = |node: &AssemblyNode, k: usize| [node.q[3 * k], node.q[3 * k + 1], node.q[3 * k + 2]];
    shown.map(|k| nodes.iter().map(|node| blade(node, k)).collect()).collect()
}
