use crate::args::JobArguments;
use crate::compare::{Row, compare_scene, methods, unless_interrupted};
use crate::error::CliError;
use crate::inspect::method_names;
use crate::interrupt::Interrupt;
use crate::saves::Saves;
use crate::{table, terminal};
use harness::report::{self, Report};
use scene::Scene;
use std::path::PathBuf;

/// Plain `noslip`: the comparison on the bundled scenes, as tables and as a report.
pub(crate) fn main_job(arguments: &JobArguments) -> Result<(), CliError> {
    let folder = match &arguments.report {
        Some(folder) => folder.clone(),
        None => free_folder(),
    };
    crate::files::check_folder(&folder, arguments.force)?;
    let mut scenes = Vec::new();
    let mut failures = Vec::new();
    let (interrupt, mut interrupted) = (Interrupt::listen(), None);
    for bundled in scene::bundled() {
        let scene = Scene::load(bundled.name, &method_names())?;
        let methods = methods(&method_names(), scene.run.alpha)?;
        let comparison = compare_scene(&scene, &methods, &mut Saves::default(), &interrupt)?;
        comparison.print(&scene)?;
        terminal::print("\n")?;
        let failed = comparison.rows.into_iter().filter_map(Row::unexpected);
        failures.extend(failed.map(|failure| format!("{}: {failure}", scene.name)));
        scenes.push(comparison.report);
        if let Some(made) = comparison.interrupted {
            interrupted = Some(format!("on the scene {} {made}", scene.name));
            break;
        }
    }
    let title = "What accuracy costs, and what structure keeps".to_owned();
    let report = Report { title, intro: table::INTRO.to_owned(), scenes };
    report::write(&report, &folder, arguments.force).map_err(CliError::Report)?;
    terminal::print(&format!("report: {}\n", folder.join("index.html").display()))?;
    unless_interrupted(interrupted, None, CliError::of_failures(failures))
}

/// The first of `noslip-report`, `noslip-report-2`, .. that is not there.
fn free_folder() -> PathBuf {
    let first = PathBuf::from("noslip-report");
    if first.symlink_metadata().is_err() {
        return first;
    }
    let numbered = |k: u32| PathBuf::from(format!("noslip-report-{k}"));
    (2..).map(numbered).find(|folder| folder.symlink_metadata().is_err()).unwrap_or(first)
}
