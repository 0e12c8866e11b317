//! Plain `noslip`: one scene by five methods, in seconds, with the result in words.

mod words;

use crate::args::JobArguments;
use crate::compare::{Comparison, compare_scene};
use crate::error::{CliError, unless_interrupted};
use crate::files::ClaimedFolder;
use crate::inspect::{method_names, methods};
use crate::interrupt::Interrupt;
use crate::resume::Saves;
use crate::row_verdict::{self, Totals};
use crate::table::ComparisonRow;
use crate::{precision, table, terminal};
use harness::precision::{Cheapest, cheapest};
use report::{Report, SceneReport};
use scene::{AnyScene, Overrides};
use serde_json::Value;
use std::path::Path;

/// The scene: its motion is regular, so that errors grow slowly, and its energy goes to and fro between its parts, so that a method
/// can lose some.
const SCENE: &str = "egg-crate";
/// One method of each kind: the discrete principle, its composition, collocation, energy, and the classical one.
const METHODS: [&str; 5] = ["dla", "dla4", "gauss16", "energy4", "rk4"];
/// A step (s) at which the methods differ, and a run (s) that is long enough to see a drift.
const STEP: f64 = 0.1;
const DURATION: f64 = 300.0;
/// Duration of the motion over which the cost of accuracy is measured (s), and maximum time of its runs (s).
const MOTION: f64 = 20.0;
const LONGEST: f64 = 0.01;
/// The errors whose price is told (m or rad).
const PRICED: [f64; 2] = [1e-3, 1e-9];

/// `noslip`, and `noslip --all`, and what their columns mean.
pub(crate) fn first(arguments: &JobArguments) -> Result<(), CliError> {
    if arguments.explain {
        return terminal::print(&words::explanation());
    }
    let folder = match &arguments.report {
        Some(folder) => ClaimedFolder::new(folder, arguments.force)?,
        None => ClaimedFolder::first_free("noslip-report")?,
    };
    if arguments.all {
        return everything(folder.path());
    }
    let names = method_names();
    let overrides = Overrides { step: Some(STEP), duration: Some(DURATION), ..Overrides::default() };
    let scene = AnyScene::load_with(SCENE, &[], &overrides, &names)?;
    let methods = methods(&METHODS, None, None)?;
    let interrupt = Interrupt::listen();
    let Comparison { rows, mut report, interrupted } = compare_scene(&scene, &methods, &Saves::default(), &interrupt)?;
    let objects: Vec<&Value> = rows.iter().map(|row| &row.json).collect();
    let mut sentences = words::sentences(&objects);
    if interrupted.is_none() {
        let mut motion = scene.clone();
        motion.run_mut().duration = MOTION;
        let measured = precision::measure(&motion, &methods, LONGEST, false, &interrupt)?;
        let priced = |price: &Cheapest| PRICED.contains(&price.error);
        let prices: Vec<Cheapest> = cheapest(&measured.curves).into_iter().filter(priced).collect();
        sentences.push(words::prices(&prices, MOTION));
    }
    let heading = words::heading(&scene);
    let cells: Vec<Vec<String>> = objects.into_iter().map(words::cells).collect();
    terminal::print(&format!("{heading}\n\n{}\n", table::left_aligned(&words::COLUMNS, &cells)))?;
    for sentence in &sentences {
        terminal::print(&table::wrapped(sentence))?;
    }

    report.columns = words::COLUMNS.map(str::to_owned).to_vec();
    report.rows = cells;
    let intro = [vec![heading], sentences].concat().join("\n\n");
    let title = "Five methods on one motion".to_owned();
    let report = Report { title, intro, notes: words::notes(), scenes: vec![report], ..Report::default() };
    report::write(&report, folder.path()).map_err(CliError::Report)?;
    terminal::print(&format!("\npage: {}\n\n{}", folder.path().join("index.html").display(), words::FURTHER))?;
    let failed = CliError::of_failures(rows.into_iter().filter_map(ComparisonRow::unexpected));
    unless_interrupted(interrupted, None, failed)
}

/// `noslip --all`: the comparison of all methods on the bundled scenes, as tables and as a report.
fn everything(folder: &Path) -> Result<(), CliError> {
    let mut scenes = Vec::new();
    let mut failures = Vec::new();
    let mut totals = Totals::default();
    let (interrupt, mut interrupted) = (Interrupt::listen(), None);
    let mut tables = String::new();
    for bundled in scene::bundled().iter().chain(scene::bundled_texts()) {
        let scene = AnyScene::load(bundled.name, &method_names())?;
        let methods = methods(&method_names(), scene.run().alpha, scene.run().tolerance)?;
        let comparison = compare_scene(&scene, &methods, &Saves::default(), &interrupt)?;
        tables += &format!("\n{}", comparison.table(&scene, false));
        comparison.rows.iter().for_each(|row| totals.add(&row.json));
        let failed = comparison.rows.into_iter().filter_map(ComparisonRow::unexpected);
        failures.extend(failed.map(|failure| format!("{}: {failure}", scene.name())));
        scenes.push(comparison.report);
        if let Some(made) = comparison.interrupted {
            interrupted = Some(format!("on the scene {}, {made}", scene.name()));
            break;
        }
    }
    let together = SceneReport {
        name: "all".to_owned(),
        title: format!("All {} scenes together", scenes.len()),
        columns: row_verdict::COLUMNS.map(str::to_owned).to_vec(),
        rows: totals.rows(),
        ..SceneReport::default()
    };
    terminal::print(&format!("{}\n{}", together.title, table::right_aligned(&row_verdict::COLUMNS, &together.rows)))?;
    terminal::print(&tables)?;
    scenes.insert(0, together);
    let title = "What accuracy costs, and what structure keeps".to_owned();
    let report = Report { title, intro: table::INTRO.to_owned(), scenes, ..Report::default() };
    report::write(&report, folder).map_err(CliError::Report)?;
    terminal::print(&format!("\nreport: {}\n", folder.join("index.html").display()))?;
    unless_interrupted(interrupted, None, CliError::of_failures(failures))
}
