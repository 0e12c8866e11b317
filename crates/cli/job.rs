use crate::compare::compare_scene;
use crate::error::{CliError, unless_interrupted};
use crate::inspect::{method_names, methods};
use crate::interrupt::Interrupt;
use crate::saves::Saves;
use crate::table::ComparisonRow;
use crate::totals::Totals;
use crate::{table, terminal};
use report::Report;
use scene::AnyScene;
use std::path::Path;

/// `noslip --all`: the comparison of all methods on the bundled scenes, as tables and as a report.
pub(crate) fn everything(folder: &Path) -> Result<(), CliError> {
    let mut scenes = Vec::new();
    let mut failures = Vec::new();
    let mut totals = Totals::default();
    let (interrupt, mut interrupted) = (Interrupt::listen(), None);
    for bundled in scene::bundled() {
        let scene = AnyScene::load(bundled.name, &method_names())?;
        let methods = methods(&method_names(), scene.run().alpha, scene.run().tolerance)?;
        let comparison = compare_scene(&scene, &methods, &Saves::default(), &interrupt)?;
        comparison.print(&scene)?;
        terminal::print("\n")?;
        comparison.rows.iter().for_each(|row| totals.add(&row.json));
        let failed = comparison.rows.into_iter().filter_map(ComparisonRow::unexpected);
        failures.extend(failed.map(|failure| format!("{}: {failure}", scene.name())));
        scenes.push(comparison.report);
        if let Some(made) = comparison.interrupted {
            interrupted = Some(format!("on the scene {}, {made}", scene.name()));
            break;
        }
    }
    terminal::print(&totals.table(scenes.len()))?;
    let title = "What accuracy costs, and what structure keeps".to_owned();
    let report = Report { title, intro: table::INTRO.to_owned(), scenes, ..Report::default() };
    report::write(&report, folder).map_err(CliError::Report)?;
    terminal::print(&format!("\nreport: {}\n", folder.join("index.html").display()))?;
    unless_interrupted(interrupted, None, CliError::of_failures(failures))
}
