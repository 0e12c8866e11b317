//! `noslip plot`: a run against time, and its path.

use crate::args::{PlotArguments, Size};
use crate::called::Caller;
use crate::columns_file::{self, Columns, NamedColumn};
use crate::error::CliError;
use crate::file_roles::FileRoles;
use crate::in_memory::{self, RunRequest};
use crate::provenance::label;
use crate::{files, inspect, table, terminal};
use report::{FigureFormat, MOST_PIXELS, Panel, Paper, Sheet, sheet};
use scene::{AnyScene, Column, Overrides};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Maximum number of nodes of a run that are drawn: a picture shows no more.
const NODES: u64 = 20_000;
/// The default columns of a sleigh; `path` is x and y.
const SLEIGH: [&str; 7] = ["path", "speed", "turn_rate", "heading", "energy", "constraint", "constraint_force"];
/// The name of the panel of x and y.
const PATH: &str = "path";

/// Draws the run of a scene or of a file.
pub(crate) fn plot(arguments: &PlotArguments) -> Result<(), CliError> {
    let PlotArguments { input, columns, size: Size(size), dpi, force, .. } = arguments;
    let path = scene::path_of(input);
    let file = matches!(files::ending(&path).as_str(), "csv" | "npz").then_some(path.as_path());
    let scene = if file.is_some() { None } else { Some(load(arguments)?) };
    let name = scene.as_ref().map_or_else(|| stem(input), |scene| scene.name().to_owned());
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.svg")));
    let format = format_of(&out)?;
    let paper = Paper { size: *size, dpi: f64::from(*dpi) };
    check_pixels(&paper, format)?;
    FileRoles::of(input).writes("--out", Some(&out)).check()?;
    files::check_file(&out, *force)?;
    let mut failures = Vec::new();
    let runs = match (&scene, file) {
        (Some(scene), _) => made(scene, arguments.methods.as_deref(), &mut failures)?,
        (None, Some(path)) => vec![(name.clone(), columns_file::read(path)?)],
        (None, None) => Vec::new(),
    };
    let title = match &scene {
        Some(scene) => title(scene, &runs),
        None => input.clone(),
    };
    let drawn = drawing(title, &runs, columns.as_deref())?;
    let bytes = sheet(&drawn, &paper, format).map_err(CliError::Report)?;
    files::write_whole(&out, *force, |file| file.write_all(&bytes))?;
    terminal::print(&format!("picture: {}\n", out.display()))?;
    CliError::of_failures(failures)
}

/// Refuses, before the run, a picture whose pixels would fill the memory.
fn check_pixels(paper: &Paper, format: FigureFormat) -> Result<(), CliError> {
    let [width, height] = paper.pixels();
    if format != FigureFormat::Png || width * height <= MOST_PIXELS {
        return Ok(());
    }
    let problem = "choose a smaller --size, a lower --dpi, or a picture .svg or .pdf, which has no pixels";
    Err(CliError::Request(format!(
        "--size and --dpi make {width:.0} x {height:.0} pixels, and a .png has at most {MOST_PIXELS:.1e}: {problem}"
    )))
}

fn load(arguments: &PlotArguments) -> Result<AnyScene, CliError> {
    let PlotArguments { input, set, step, duration, alpha, .. } = arguments;
    let names = inspect::method_names();
    let overrides = Overrides { method: None, step: *step, duration: *duration, alpha: *alpha };
    Ok(AnyScene::load_with(input, &set.set, &overrides, &names)?)
}

fn stem(path: &str) -> String {
    Path::new(path).file_stem().map_or_else(|| "picture".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

fn format_of(path: &Path) -> Result<FigureFormat, CliError> {
    match files::ending(path).as_str() {
        "svg" => Ok(FigureFormat::Svg),
        "png" => Ok(FigureFormat::Png),
        "pdf" => Ok(FigureFormat::Pdf),
        _ => {
            let problem = "a picture is written as .svg, .png or .pdf, by the ending of the name";
            Err(CliError::Request(format!("{}: {problem}", path.display())))
        }
    }
}

/// The title of the figure.
pub(crate) fn title(scene: &AnyScene, runs: &[(String, Columns)]) -> String {
    let by = match runs {
        [(method, _)] => format!("{method}, "),
        _ => String::new(),
    };
    format!("{}; {by}step {} s", scene.title(), table::number(scene.run().actual_step()))
}

/// The runs of a scene, by method.
pub(crate) fn made(
    scene: &AnyScene,
    names: Option<&[String]>,
    failures: &mut Vec<String>,
) -> Result<Vec<(String, Columns)>, CliError> {
    let names = match names {
        Some(_) => inspect::listed(names),
        None => vec![scene.run().method.as_str()],
    };
    inspect::methods(&names, scene.run().alpha, scene.run().tolerance)?;
    let request = RunRequest { every: scene.run().steps().div_ceil(NODES), ..RunRequest::default() };
    names.iter().map(|method| run(scene, method, &request, failures)).collect()
}

/// The run of a scene by a method, as far as it comes.
fn run(
    scene: &AnyScene,
    method: &str,
    request: &RunRequest,
    failures: &mut Vec<String>,
) -> Result<(String, Columns), CliError> {
    let overrides = Overrides { method: Some(method), ..Overrides::default() };
    let scene = scene.clone().with_overrides(&overrides, &inspect::method_names())?;
    let result = in_memory::run(&scene, request, &Caller::default()).map_err(|error| match error.request {
        true => CliError::Request(error.message),
        false => CliError::Computation(vec![error.message]),
    })?;
    failures.extend(result.failure);
    let columns = result.columns.into_iter().zip(result.numbers);
    let columns = columns.map(|(Column { name, unit, .. }, values)| NamedColumn { name, unit, values });
    Ok((method.to_owned(), columns.collect()))
}

/// The sheet of some runs; of columns that are not named, what a reader looks at first.
pub(crate) fn drawing(
    title: String,
    runs: &[(String, Columns)],
    columns: Option<&[String]>,
) -> Result<Sheet, CliError> {
    let first = runs.first().map_or(&[][..], |(_, columns)| &columns[..]);
    let has = |name: &str| first.iter().any(|column| column.name == name);
    let path = has("x") && has("y");
    let known: Vec<&str> =
        path.then_some(PATH).into_iter().chain(first.iter().map(|column| column.name.as_str())).collect();
    let names: Vec<String> = match columns {
        Some(names) => names.iter().map(|name| name.trim().to_owned()).collect(),
        None if has("speed") && has("turn_rate") => {
            SLEIGH.iter().filter(|name| known.contains(name)).map(|name| (*name).to_owned()).collect()
        }
        None => {
            // Coordinates that are drawn as a path need no panels of their own.
            let shown = |name: &&&str| **name != "t" && !(path && matches!(**name, "x" | "y"));
            known.iter().filter(shown).map(|name| (*name).to_owned()).collect()
        }
    };
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str()) || !has("t")) {
        let problem =
            format!("the run has no column `{unknown}` to draw against `t`; the columns are {}", known.join(", "));
        return Err(CliError::Request(problem));
    }
    let panels = names.iter().map(|name| panel(name, runs)).collect();
    Ok(Sheet { title, runs: runs.iter().map(|(name, _)| name.clone()).collect(), panels })
}

fn panel(name: &str, runs: &[(String, Columns)]) -> Panel {
    let (across, up) = if name == PATH { ("x", "y") } else { ("t", name) };
    let column = |columns: &'_ Columns, name: &str| columns.iter().find(|column| column.name == name).cloned();
    let title = |name: &str| {
        let unit = runs.first().and_then(|(_, columns)| column(columns, name)).map_or_else(String::new, |of| of.unit);
        label(&Column::new(words(name), unit))
    };
    let mut axes = [title(across), title(up)];
    let mut curves: Vec<Vec<[f64; 2]>> = runs
        .iter()
        .map(|(_, columns)| match (column(columns, across), column(columns, up)) {
            (Some(x), Some(y)) => x.values.into_iter().zip(y.values).map(|(x, y)| [x, y]).collect(),
            _ => Vec::new(),
        })
        .collect();
    if name == "energy" && nearly_constant(&curves) {
        for curve in &mut curves {
            let start = curve.first().map_or(0.0, |point| point[1]);
            curve.iter_mut().for_each(|point| point[1] -= start);
        }
        axes[1] = format!("E − E₀{}", axes[1].trim_start_matches("energy"));
    }
    let decades = name == "constraint";
    if decades {
        axes[1] = format!("|{}|{}", words(name), axes[1].trim_start_matches(&words(name)));
    }
    Panel { axes, curves, decades, path: name == PATH }
}

/// Whether a column changes by less than a hundredth of itself: then it is the change that tells something.
fn nearly_constant(curves: &[Vec<[f64; 2]>]) -> bool {
    curves.iter().all(|curve| {
        let start = curve.first().map_or(0.0, |point| point[1]);
        curve.iter().all(|point| (point[1] - start).abs() <= 0.01 * start.abs())
    })
}

/// The name of a column in words.
fn words(name: &str) -> String {
    if name == "constraint_force" { "reaction".to_owned() } else { name.replace('_', " ") }
}
