use super::{facts, told};
use crate::compare::{Comparison, REFERRED, Row, better_than, progress_of};
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::saves::Saves;
use crate::{compare_numbers, inspect, json, table};
use dla::{Schedule, State};
use harness::report::{SceneReport, Series};
use harness::{Drift, Method, Record, Request, Verdict};
use scene::{Model, StartedText, TextScene, with_text};

/// Runs every method on a system of text, until Ctrl-C.
pub(crate) fn compare_scene(
    scene: &TextScene,
    methods: &[Method],
    saves: &mut Saves,
    interrupt: &Interrupt,
) -> Result<Comparison, CliError> {
    told::note_moves(scene);
    with_text!(super::system(scene)?, started => compared(scene, &started, methods, saves, interrupt))
}

fn compared<const N: usize, const M: usize>(
    scene: &TextScene,
    started: &StartedText<N, M>,
    methods: &[Method],
    saves: &mut Saves,
    interrupt: &Interrupt,
) -> Result<Comparison, CliError> {
    let (system, q, v) = (&*started.system, started.q, started.v);
    let model = system.model();
    let request = Request { schedule: inspect::steps_of(&scene.run), q, v, samples: 1000 };
    let mut records: Vec<Record<N>> = Vec::new();
    for method in methods {
        if interrupt.asked() {
            break;
        }
        let mut progress = progress_of(&scene.name, method.info().name, request.schedule.steps, interrupt);
        records.push(saves.run(
            (&scene.name, &(&scene.words, &scene.start, &scene.run)),
            system.into(),
            method,
            &request,
            &mut progress,
        )?);
        progress.bar.finish_and_clear();
    }
    let reference = reference(scene, started, &request.schedule, interrupt);
    let drifts: Vec<(&str, Drift)> =
        records.iter().filter(|r| r.is_whole()).map(|r| (r.method.name, r.energy.drift)).collect();
    let (mut rows, mut series) = (Vec::new(), Vec::new());
    for record in &records {
        let whole = record.is_whole();
        let there = reference.as_ref().filter(|(t, _)| whole && (t - record.t).abs() <= 1e-9 * t.abs());
        let error = there.map(|(_, end)| distance(&record.q, end));
        let better = if whole { better_than(&record.energy.drift, &drifts) } else { Vec::new() };
        let end = told::json(model, record.t, &record.q, &record.v);
        rows.push(Row {
            cells: table::cells(record, error),
            json: json::compared_of(&scene.name, record, &end, error, &better),
            better: table::better(record, &better),
            failure: table::failure(record),
            refused: record.refusal().is_some(),
        });
        series.push(series_of(model, record));
    }
    let whole = records.iter().filter(|record| !record.interrupted).count();
    let interrupted = (whole < methods.len()).then(|| format!("{whole} of {} methods are done", methods.len()));
    let objects: Vec<_> = rows.iter().map(|row| &row.json).collect();
    let report = SceneReport {
        name: scene.name.clone(),
        title: scene.title.clone(),
        facts: facts::listed(scene),
        columns: table::COLUMNS.iter().map(|column| (*column).to_owned()).collect(),
        rows: rows.iter().map(|row| row.cells.clone()).collect(),
        series,
        exact_path: None,
        figure: None,
        numbers: compare_numbers::files(&scene.name, &objects, interrupted.is_some()),
    };
    Ok(Comparison { rows, report, interrupted })
}

/// When and where the motion ends by the method of the highest order with a quarter of the step; none of a long run.
fn reference<const N: usize, const M: usize>(
    scene: &TextScene,
    StartedText { system, q, v }: &StartedText<N, M>,
    schedule: &Schedule,
    interrupt: &Interrupt,
) -> Option<(f64, [f64; N])> {
    if schedule.steps > REFERRED || interrupt.asked() {
        return None;
    }
    let method = Method::named("gauss16", None).ok()?;
    let fine = Schedule { step: 0.25 * schedule.step, steps: 4 * schedule.steps, ..*schedule };
    let mut state = State::new(*q, *v, system.angles());
    let mut progress = progress_of(&scene.name, "reference", fine.steps, interrupt);
    let made = harness::integrate_on(&**system, &method, &fine, &mut state, &mut (), &mut progress);
    progress.bar.finish_and_clear();
    Some((fine.time(made.ok()?), state.unwrapped()))
}

/// The largest distance of a coordinate.
pub(crate) fn distance<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| lagrangian::linear::larger(most, a - b))
}

/// What the pictures show: the path, where there are coordinates `x` and `y`, and the heading, where an angle has that name or is the only
/// one.
fn series_of<const N: usize>(model: &Model, record: &Record<N>) -> Series {
    let samples = if record.steps == 0 { &[][..] } else { &record.samples[..] };
    let named = |name: &str| model.coordinates().iter().position(|coordinate| coordinate.name == name);
    let path = named("x").zip(named("y"));
    let heading = path.and_then(|_| ["heading", "theta", "phi", "psi"].into_iter().find_map(named));
    Series {
        label: record.method.name.to_owned(),
        path: path.map_or_else(Vec::new, |(x, y)| samples.iter().map(|sample| [sample.q[x], sample.q[y]]).collect()),
        heading: heading.map_or_else(Vec::new, |i| samples.iter().map(|sample| sample.q[i]).collect()),
        time: samples.iter().map(|sample| sample.t).collect(),
        constraint: samples.iter().map(|sample| sample.constraint).collect(),
        energy_error: samples.iter().map(|sample| sample.energy_error).collect(),
        failed: record.failure.is_some(),
        diverged: record.energy.drift.verdict == Verdict::Diverged,
        ..Series::default()
    }
}
