//! The report of a comparison: one page that works offline, and the pictures on it as files of their own.
//!
//! A report takes plain numbers and finished text, so that it says exactly what the terminal says. [`write()`] puts a
//! page `index.html` and, for each scene, `NAME-path`, `NAME-constraint` and `NAME-energy`, each as `.svg` and as `.png`,
//! into a folder, with the numbers that the scene brings. The page holds its pictures, its style and its script itself, and
//! needs no network. It is light or dark as its reader prefers; the files have a light ground. Each scene can be seen in
//! motion; `index.html#play` starts the first.

use std::io;
use std::path::{Path, PathBuf};

mod animation;
mod axis;
mod canvas;
mod cells;
mod chart;
mod diagram;
mod drift;
mod figure;
mod files;
mod geometry;
mod letters;
mod look;
mod page;
mod path;
mod pdf;
mod picture;
mod png;
mod precision;
mod raster;
mod scale;
mod sleigh;
mod thinning;
mod xml;

pub use cells::Cells;
pub use chart::{Chart, Layer, chart_svg};
pub use figure::{Figure, Panel, Paper, figure};
pub use picture::FigureFormat;
pub use precision::{PrecisionReport, PrecisionTable, write_precision};
pub use raster::MOST_PIXELS;

/// A report: what the page says above its scenes, and the scenes.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// The heading of the page.
    pub title: String,
    /// What was compared, in a few sentences; an empty line starts a new paragraph.
    pub intro: String,
    /// What the columns of the tables mean: shown at their headings, and in a list below the scenes.
    pub notes: Vec<(String, String)>,
    /// The scenes, in the order of the page.
    pub scenes: Vec<SceneReport>,
}

/// What the report shows of one scene.
#[derive(Debug, Clone, Default)]
pub struct SceneReport {
    /// The short name that the picture files start with; characters unfit for a file name become `-`.
    pub name: String,
    /// The heading of the scene.
    pub title: String,
    /// Names and values, such as `("mass", "1 kg")`.
    pub facts: Vec<(String, String)>,
    /// The headings of the comparison table.
    pub columns: Vec<String>,
    /// The rows of the comparison table, already formatted. The last cell of a row that is shorter than the others takes
    /// the columns that are left.
    pub rows: Vec<Vec<String>>,
    /// The runs that the pictures show, one per method.
    pub series: Vec<Series>,
    /// The blade's exact path \[m\], where one is known.
    pub exact_path: Option<Vec<[f64; 2]>>,
    /// What else is shown against time, a panel below the other, as the picture `NAME-run`.
    pub figure: Option<Figure>,
    /// Files of numbers to put beside the page as `NAME.ENDING`.
    pub numbers: Vec<Numbers>,
}

/// A file of numbers.
#[derive(Debug, Clone)]
pub struct Numbers {
    /// The ending of its name, such as `csv`, or `csv-metadata.json` of what describes that file.
    pub ending: &'static str,
    /// What is in it.
    pub text: String,
}

/// The columns along which a body may point in pictures of its path, in the order in which they are looked for.
pub const HEADINGS: [&str; 4] = ["heading", "theta", "phi", "psi"];

/// One run of one method.
///
/// The vectors hold one entry per node. Where lengths differ, the shorter one counts; entries that are not finite are
/// left out of the pictures and interrupt their lines. A run without nodes is not drawn; the others keep their looks.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// The name of the method.
    pub label: String,
    /// The blade's position \[m\].
    pub path: Vec<[f64; 2]>,
    /// The heading \[rad\].
    pub heading: Vec<f64>,
    /// The angle of a rotor relative to the sleigh \[rad\]; empty where there is none.
    pub rotor: Vec<f64>,
    /// The places \[m\] and headings \[rad\] of the blades behind it, one list after the other, each of all nodes; empty where
    /// none follows.
    pub followers: Vec<Vec<[f64; 3]>>,
    /// The time \[s\].
    pub time: Vec<f64>,
    /// The size of the constraint's residual, `|A(q) v + b|`.
    pub constraint: Vec<f64>,
    /// The energy beyond its initial value that no work explains, `|E - E0 - W|` \[J\].
    pub energy_error: Vec<f64>,
    /// The run failed at its last node: its lines end in a cross.
    pub failed: bool,
    /// The run blew up: the pictures are scaled to the others.
    pub diverged: bool,
}

impl Series {
    /// Whether there is anything to draw.
    fn is_drawn(&self) -> bool {
        !self.time.is_empty() || !self.path.is_empty()
    }
}

/// The runs that pictures are scaled to: those that did not blow up; all of them where all did.
fn scaling(scene: &SceneReport) -> impl Iterator<Item = &Series> {
    let all = scene.series.iter().filter(|series| series.is_drawn()).all(|series| series.diverged);
    scene.series.iter().filter(move |series| all || !series.diverged)
}

/// The run that stands for the motion of the scene: the first that reached its end without blowing up, or the first that can be drawn.
fn leading(scene: &SceneReport) -> Option<(usize, &Series)> {
    let drawn = || scene.series.iter().enumerate().filter(|(_, series)| series.is_drawn());
    drawn().find(|(_, series)| !series.failed && !series.diverged).or_else(|| drawn().next())
}

/// What a caption says of the runs that failed, if any did.
fn failures(scene: &SceneReport) -> String {
    let failed = scene.series.iter().filter(|series| series.is_drawn() && series.failed);
    let failed: Vec<&str> = failed.map(|series| series.label.as_str()).collect();
    if failed.is_empty() { String::new() } else { format!(" A cross marks where a run failed: {}.", failed.join(", ")) }
}

/// The entries of a legend: the runs that are drawn, each with its own look.
fn entries(scene: &SceneReport) -> Vec<axis::LegendEntry<'_>> {
    let drawn = scene.series.iter().enumerate().filter(|(_, series)| series.is_drawn());
    drawn.map(|(method, series)| (canvas::Ink::Method(method), series.label.as_str())).collect()
}

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The folder is there already, and overwriting was not asked for.
    #[error("{} exists already", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// A file or folder could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A picture could not be drawn.
    #[error("cannot draw {picture}: {reason}")]
    Draw {
        /// The name of the picture's file.
        picture: String,
        /// What the drawing library said.
        reason: String,
    },
}

/// Writes a report into a folder and returns the files: the page first, then the pictures and the numbers, scene by scene.
///
/// A new folder appears whole or not at all; the folder that holds it must exist. With `overwrite`, an existing folder
/// keeps every file that is not part of the report, and each file of the report is replaced in one step, the page
/// last, and none of them before all of them are on the disk.
///
/// # Errors
///
/// [`ReportError::Exists`] if something with that name is there and `overwrite` is false; [`ReportError::Io`] if the
/// system refuses to write, in which case no new file is left behind; [`ReportError::Draw`] if the drawing library
/// fails.
pub fn write(report: &Report, directory: &Path, overwrite: bool) -> Result<Vec<PathBuf>, ReportError> {
    // Asked first, so that no picture is drawn in vain; asked again, by the rename itself, at the end.
    if !overwrite && directory.symlink_metadata().is_ok() {
        return Err(ReportError::Exists { path: directory.to_path_buf() });
    }
    let names = files::stems(report.scenes.iter().map(|scene| scene.name.as_str()));
    let mut scenes = Vec::with_capacity(names.len());
    let mut contents = vec![(PAGE.to_owned(), Vec::new())];
    for (scene, name) in report.scenes.iter().zip(&names) {
        let pictures = pictures(scene, name)?;
        for picture in &pictures {
            contents.extend(picture.files()?);
        }
        let figure = scene.figure.as_ref().map(|shown| figure::column(shown, format!("{name}-run"))).transpose()?;
        contents.extend(figure.as_ref().map(picture::Picture::files).transpose()?.into_iter().flatten());
        contents.extend(numbered(name, &scene.numbers));
        scenes.push(page::ShownScene { name, pictures, figure, animation: animation::figure(scene)? });
    }
    contents[0].1 = page::page(report, &scenes).into_bytes();
    files::write_all(directory, &contents, overwrite)
}

/// The name of the page.
const PAGE: &str = "index.html";
/// The picture of the paths of a scene, seen from above, as the text of an SVG file.
///
/// # Errors
/// [`ReportError::Draw`] if the drawing library fails.
pub fn path_picture(scene: &SceneReport) -> Result<String, ReportError> {
    Ok(path::picture(scene, &scene.name)?.standalone())
}

/// The three pictures of a scene.
fn pictures(scene: &SceneReport, name: &str) -> Result<[picture::Picture; 3], ReportError> {
    Ok([path::picture(scene, name)?, drift::constraint(scene, name)?, drift::energy(scene, name)?])
}

/// What the names of the files of a scene in a report begin with, if no other scene of the report has the same name.
#[must_use]
pub fn file_stem(name: &str) -> String {
    files::stems(std::iter::once(name)).concat()
}

/// Files of numbers with their names.
fn numbered(name: &str, numbers: &[Numbers]) -> impl Iterator<Item = (String, Vec<u8>)> {
    numbers.iter().map(move |file| (format!("{name}.{}", file.ending), file.text.clone().into_bytes()))
}
