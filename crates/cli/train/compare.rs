use super::columns::SHOWN;
use crate::comparison::{Comparison, REFERRED, WITHOUT_REFERENCE, better_than};
use crate::error::CliError;
use crate::in_memory::MOST_NUMBERS;
use crate::interrupt::Interrupt;
use crate::progress::Interruptible;
use crate::table::ComparisonRow;
use crate::{compare_numbers, facts, json, notes, progress, table};
use assembly::AssemblyState;
use assembly::parts::Train;
use dla::Schedule;
use harness::{Assembled, AssemblyNode, Drift, DriftVerdict, Method, assembly_end, run_assembly};
use report::{SceneReport, Series};
use scene::Scene;
use sleigh::SleighState;

/// Runs every method on a train, until Ctrl-C.
pub(crate) fn compare_scene(
    scene: &Scene,
    (train, start): &(Train, AssemblyState),
    methods: &[Method],
    interrupt: &Interrupt,
) -> Result<Comparison, CliError> {
    let (assembly, schedule) = (&train.assembly, scene.schedule());
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
    // Without a reference there was no time for it, or a signal has ended the work on it.
    let lost = interrupt.asked() && is_referred(&schedule, start);
    let drifts: Vec<(&str, Drift)> = runs
        .iter()
        .filter(|run| run.record.is_whole())
        .map(|run| (run.record.method.name, run.record.energy.drift))
        .collect();
    let (mut rows, mut series) = (Vec::new(), Vec::new());
    for Assembled { record, nodes, end, .. } in &runs {
        let end = train.blade(end, 0);
        let error =
            reference.as_ref().filter(|_| record.is_whole()).map(|state| distance(&end, &train.blade(state, 0)));
        notes::warn_of_jumps(record);
        let better = if record.is_whole() { better_than(&record.energy.drift, &drifts) } else { Vec::new() };
        rows.push(ComparisonRow {
            cells: table::cells(record, error),
            json: json::compared(&scene.name, record, &end, error, &better),
            better: table::better(record, &better),
            failure: table::failure(record),
            refused: record.refusal().is_some(),
        });
        let drawn = if record.steps == 0 { &[][..] } else { &nodes[..] };
        let sampled = |of: fn(&harness::Sample) -> f64| record.samples.iter().take(drawn.len()).map(of).collect();
        series.push(Series {
            label: record.method.name.to_owned(),
            path: drawn.iter().map(|node| [node.q[0], node.q[1]]).collect(),
            heading: drawn.iter().map(|node| node.q[2]).collect(),
            followers: followers(train, drawn),
            time: drawn.iter().map(|node| node.t).collect(),
            constraint: sampled(|sample| sample.constraint),
            energy_error: sampled(|sample| sample.energy_error),
            failed: record.failure.is_some(),
            diverged: record.energy.drift.verdict == DriftVerdict::Diverged,
            ..Series::default()
        });
    }
    let whole = runs.iter().filter(|run| !run.record.interrupted).count();
    let interrupted = match whole < methods.len() {
        true => Some(format!("{whole} of {} methods finished", methods.len())),
        false => reference.is_none().then(|| WITHOUT_REFERENCE.to_owned()).filter(|_| lost),
    };
    let objects: Vec<_> = rows.iter().map(|row| &row.json).collect();
    let report = SceneReport {
        name: scene.name.clone(),
        title: scene.title.clone(),
        facts: facts::of_sleigh(scene, &scene.start, assembly.energy(0.0, start), ""),
        columns: table::COLUMNS.iter().map(|column| (*column).to_owned()).collect(),
        rows: rows.iter().map(|row| row.cells.clone()).collect(),
        series,
        numbers: compare_numbers::files(
            &scene.name,
            (&scene.title, scene.to_toml().ok()),
            &objects,
            interrupted.as_deref(),
        ),
        ..SceneReport::default()
    };
    Ok(Comparison { rows, report, interrupted })
}

/// Whether there is time for a reference.
fn is_referred(schedule: &Schedule, start: &AssemblyState) -> bool {
    schedule.steps.saturating_mul(start.len() as u64) <= REFERRED
}

/// Where the motion ends by dla8 with a quarter of the step; none of a run that would take longer than all others.
fn reference(
    scene: &Scene,
    train: &Train,
    start: &AssemblyState,
    schedule: &Schedule,
    interrupt: &Interrupt,
) -> Option<AssemblyState> {
    if !is_referred(schedule, start) || interrupt.asked() {
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

/// Places and headings of the trailers at every node, those that a report shows.
fn followers(train: &Train, nodes: &[AssemblyNode]) -> Vec<Vec<[f64; 3]>> {
    let shown = 1..=train.trailers().len().min(SHOWN);
    let blade = |node: &AssemblyNode, k: usize| [node.q[3 * k], node.q[3 * k + 1], node.q[3 * k + 2]];
    shown.map(|k| nodes.iter().map(|node| blade(node, k)).collect()).collect()
}

/// The larger of the distances in position [m] and in heading [rad].
pub(super) fn distance(a: &SleighState, b: &SleighState) -> f64 {
    let (place, turn) = (f64::hypot(a.x - b.x, a.y - b.y), (a.heading - b.heading).abs());
    if place > turn || place.is_nan() { place } else { turn }
}
