//! `noslip run --report`: one run as a page.

use crate::args::RunArguments;
use crate::columns_file::{Columns, NamedColumn};
use crate::error::CliError;
use crate::files::ClaimedFolder;
use crate::provenance::label;
use crate::{facts, inspect, plot, table, terminal, train};
use report::{Body, HEADINGS, Report, SceneReport, Series};
use scene::{AnyScene, Column};

/// Makes the run, and its page if one is asked for. For the page it is made a second time, with fewer nodes kept.
pub(crate) fn run_and_show(arguments: &RunArguments) -> Result<(), CliError> {
    let Some(folder) = &arguments.report else { return crate::run::run(arguments) };
    let shared = &arguments.scene;
    if shared.scene == "-" {
        let problem = "--report reads the scene twice, and the standard input can be read only once";
        return Err(CliError::Request(problem.to_owned()));
    }
    let folder = ClaimedFolder::new(folder, shared.force)?;
    let scene = inspect::load(shared, arguments.method.as_deref())?;
    let outcome = crate::run::run(arguments);
    // A run that failed on the way is shown as far as it came.
    if !matches!(outcome, Ok(()) | Err(CliError::Computation(_))) {
        return outcome;
    }
    let mut failures = Vec::new();
    let runs = plot::made(&scene, None, &mut failures)?;
    let [(method, columns)] = &runs[..] else { return outcome };
    let mut figure = plot::drawing(plot::title(&scene, &runs), &runs, None)?;
    // The page has pictures of these.
    figure.panels.retain(|panel| !panel.path && !panel.decades);
    let exact = match &scene {
        AnyScene::Sleigh(scene) => scene.exact().ok().flatten(),
        AnyScene::Text(_) => None,
    };
    let mut series = series(method, columns, !failures.is_empty());
    if let Some(train) = scene.built()?.system().train() {
        series.followers = train::followers(train, columns);
    }
    let exact_path = exact.map(|exact| series.time.iter().map(|t| exact.at(*t)).map(|s| [s.x, s.y]).collect());
    let shown = SceneReport {
        name: scene.name().to_owned(),
        title: scene.title().to_owned(),
        body: if matches!(scene, AnyScene::Sleigh(_)) { Body::Sleigh } else { Body::Other },
        facts: facts::described(&scene)?,
        columns: ["column", "start", "end", "least", "largest"].map(str::to_owned).to_vec(),
        rows: columns.iter().map(row).collect(),
        series: vec![series],
        exact_path,
        figure: Some(figure),
        ..SceneReport::default()
    };
    let title = format!("noslip run {} with {method}", scene.name());
    let report = Report { title, scenes: vec![shown], ..Report::default() };
    report::write(&report, folder.path()).map_err(CliError::Report)?;
    if !shared.json {
        terminal::print(&format!("report: {}\n", folder.path().join("index.html").display()))?;
    }
    outcome
}

/// A column in four numbers.
fn row(NamedColumn { name, unit, values }: &NamedColumn) -> Vec<String> {
    let [least, largest] =
        values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    let ends = [values.first(), values.last()].map(|x| x.copied().unwrap_or(f64::NAN));
    let numbers = [ends[0], ends[1], least, largest].map(|x| table::number(format!("{x:.5e}").parse().unwrap_or(x)));
    std::iter::once(label(&Column::new(name, unit))).chain(numbers).collect()
}

/// The curves of the run in the pictures of a page.
fn series(method: &str, columns: &Columns, failed: bool) -> Series {
    let column = |name: &str| columns.iter().find(|column| column.name == name).map(|column| column.values.clone());
    let values = |name: &str| column(name).unwrap_or_default();
    let energy = values("energy");
    let work = column("work").unwrap_or_else(|| vec![0.0; energy.len()]);
    let start = energy.first().zip(work.first()).map_or(0.0, |(energy, work)| energy - work);
    let [x, y] = ["x", "y"].map(values);
    let heading = if x.is_empty() { None } else { HEADINGS.into_iter().find_map(column) };
    Series {
        label: method.to_owned(),
        path: x.iter().zip(&y).map(|(x, y)| [*x, *y]).collect(),
        heading: heading.unwrap_or_default(),
        rotor: values("rotor_angle"),
        time: values("t"),
        constraint: values("constraint"),
        energy_error: energy.iter().zip(&work).map(|(energy, work)| (energy - work - start).abs()).collect(),
        failed,
        ..Series::default()
    }
}
