//! Pages and pictures of runs: a comparison as one page that works offline, and the pictures on it as files of their own.
//!
//! A report takes plain numbers and finished text, so that it says exactly what the terminal says. [`write()`] puts a
//! page `index.html` and, for each scene, `NAME-path`, `NAME-constraint` and `NAME-energy`, each as `.svg` and as `.png`,
//! into a folder, with the numbers that the scene brings. The page holds its pictures, its style and its script itself, and
//! needs no network. It is light or dark as its reader prefers; the files have a light ground. Each scene can be seen in
//! motion; `index.html#play` starts the first. [`chart_svg`] and [`sheet()`] draw single pictures.

mod animation;
mod canvas;
mod chart;
mod costs;
mod drift;
mod figure;
mod files;
mod frame;
mod look;
mod outlines;
mod page;
mod path;
mod pdf;
mod picture;
mod raster;
mod sheet;
mod sleigh;
mod svg;
mod thinning;
mod ticks;

pub use chart::{Cells, Chart, Layer, chart_svg};
pub use costs::{CostCurve, CostPoint};
pub use picture::FigureFormat;
pub use raster::MOST_PIXELS;
pub use sheet::{Panel, Paper, Sheet, sheet};

use look::Ink;
use std::io;
use std::path::{Path, PathBuf};

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
    /// Further tables below them.
    pub tables: Vec<Table>,
}

/// A table of finished text. The last cell of a row that is shorter than the others takes the columns that are left.
#[derive(Debug, Clone)]
pub struct Table {
    /// The heading.
    pub title: String,
    /// The headings of the columns.
    pub columns: Vec<String>,
    /// The rows; one that begins with the label of a curve of costs begins with its look.
    pub rows: Vec<Vec<String>>,
}

/// What moves in the pictures of a scene, and in whose words they speak.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Body {
    /// A sleigh on its blade.
    #[default]
    Sleigh,
    /// Any other system, shown by an arrow at its place.
    Other,
}

/// What the report shows of one scene.
#[derive(Debug, Clone, Default)]
pub struct SceneReport {
    /// What moves.
    pub body: Body,
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
    /// The blade's exact path \[m\], if known.
    pub exact_path: Option<Vec<[f64; 2]>>,
    /// What else is shown against time, a panel below the other, as the picture `NAME-run`.
    pub figure: Option<Sheet>,
    /// What accuracy costs, method by method: the diagrams `NAME-time` and `NAME-step` in place of all other pictures.
    pub costs: Option<Vec<CostCurve>>,
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
    /// The angle of a rotor relative to the sleigh \[rad\]; empty without a rotor.
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

impl SceneReport {
    /// Whether it is a table alone, without runs to draw.
    fn is_table(&self) -> bool {
        self.series.is_empty() && self.costs.is_none() && self.figure.is_none()
    }

    /// The runs that are drawn, each with its place among all.
    fn drawn(&self) -> impl Iterator<Item = (usize, &Series)> {
        self.series.iter().enumerate().filter(|(_, series)| series.is_drawn())
    }

    /// The runs whose range the pictures show: all runs that did not blow up, or all runs if every one did.
    fn scaling(&self) -> impl Iterator<Item = &Series> {
        let all = self.drawn().all(|(_, series)| series.diverged);
        self.drawn().map(|(_, series)| series).filter(move |series| all || !series.diverged)
    }

    /// The run that stands for the motion of the scene: the first that reached its end without blowing up, or the first that can be drawn.
    fn leading(&self) -> Option<(usize, &Series)> {
        self.drawn().find(|(_, series)| !series.failed && !series.diverged).or_else(|| self.drawn().next())
    }

    /// The points of the exact path; `None` if there are none.
    fn exact(&self) -> Option<&[[f64; 2]]> {
        self.exact_path.as_deref().filter(|path| !path.is_empty())
    }

    /// The entries of a legend: the runs that are drawn, each with its own look.
    fn legend(&self) -> Vec<figure::LegendEntry<'_>> {
        self.drawn().map(|(method, series)| (Ink::Method(method), series.label.as_str())).collect()
    }

    /// The caption's remarks on runs whose curves leave the picture, and on failed runs.
    fn remarks(&self, leaves: impl Fn(usize) -> bool) -> String {
        let strays = self.series.iter().enumerate().filter(|(method, _)| leaves(*method));
        let strays: Vec<&str> = strays.map(|(_, series)| series.label.as_str()).collect();
        let failed = self.drawn().filter(|(_, series)| series.failed);
        let failed: Vec<&str> = failed.map(|(_, series)| series.label.as_str()).collect();
        let said = [(" Curves that leave the picture", strays), (" A cross marks where a run failed", failed)];
        let said = said.into_iter().filter(|(_, runs)| !runs.is_empty());
        said.map(|(what, runs)| format!("{what}: {}.", runs.join(", "))).collect()
    }
}

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A picture could not be drawn, and why.
    #[error("cannot draw the picture: {0}")]
    Draw(String),
}

/// Writes a report into a folder that is there, and returns the files: the page first, then the pictures and the numbers, scene by scene.
///
/// The folder keeps every file that is not part of the report, and each file of the report is replaced in one step, the page last, and none
/// of them before all of them are on the disk.
///
/// # Errors
///
/// [`ReportError::Io`] if the system refuses to write, in which case no new file is left behind; [`ReportError::Draw`] if a picture is too
/// large.
pub fn write(report: &Report, directory: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let names = files::stems(report.scenes.iter().map(|scene| scene.name.as_str()));
    let mut scenes = Vec::with_capacity(names.len());
    let mut contents = vec![(page::PAGE.to_owned(), Vec::new())];
    for (scene, name) in report.scenes.iter().zip(&names) {
        let (figures, animation) = if scene.is_table() {
            (Vec::new(), None)
        } else if let Some(costs) = &scene.costs {
            let picture = |time| costs::picture(costs, &scene.title, name, time);
            (vec![picture(true), picture(false)], None)
        } else {
            let drifts = [drift::CONSTRAINT, drift::ENERGY].map(|shown| drift::picture(scene, name, &shown));
            let sheet = scene.figure.as_ref().map(|shown| sheet::column(shown, format!("{name}-run")));
            let figures = [path::picture(scene, name)].into_iter().chain(drifts).chain(sheet).collect();
            (figures, animation::figure(scene))
        };
        for figure in &figures {
            contents.extend(figure.files()?);
        }
        contents.extend(files::numbered(name, &scene.numbers));
        scenes.push(page::ShownScene { name, figures, animation });
    }
    contents[0].1 = page::page(report, &scenes).into_bytes();
    files::replace(directory, contents)
}

/// The picture of the paths of a scene, seen from above, as the text of an SVG file.
#[must_use]
pub fn path_picture(scene: &SceneReport) -> String {
    path::picture(scene, &scene.name).svg(1.0)
}

/// What the names of the files of a scene in a report begin with, if no other scene of the report has the same name.
#[must_use]
pub fn file_stem(name: &str) -> String {
    files::stems(std::iter::once(name)).concat()
}
