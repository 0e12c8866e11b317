//! A sheet for a paper: columns of runs against time, and their paths, with the titles of axes where journals have them.

use super::ReportError;
use super::canvas::{Anchor, text_width};
use super::figure::{Axis, Figure, LegendEntry, SIZE};
use super::frame::{Scale, Span, drawable};
use super::look::Ink;
use super::picture::{FigureFormat, UNITS_PER_INCH};
use super::svg::label;
use super::thinning::peaks;
use super::ticks::{Tick, decades, linear, margin, whole_decades};
use std::borrow::Cow;

const CENTIMETRES_PER_INCH: f64 = 2.54;
/// Maximum number of points of a curve, and of a curve on a logarithmic axis, each the largest value of a stretch.
const POINTS: usize = 2000;
const PEAKS: usize = 120;
/// Room below the frame of a panel, above it and to the right; and between figures and title of an upright axis.
const BELOW: f64 = 44.0;
const ABOVE: f64 = 10.0;
const BESIDE: f64 = 16.0;
const TITLE: f64 = 12.0;
/// The least length of an axis; on a paper that is too small for more, figures are cut off and curves are not.
const SHORTEST: f64 = 20.0;
/// The height of the sheet's title.
const HEADING: f64 = 26.0;
/// The ratio of width to height that a panel should have.
const RATIO: f64 = 1.6;
/// A panel that is lower than this (units) has smaller letters and lines, down to a part of their size.
const LOWEST: f64 = 165.0;
const SMALLEST: f64 = 0.65;
/// The decade of the rounding of numbers near 1: smaller sizes are shown at it.
const FLOOR: f64 = -16.0;
/// The width of a picture of a page, and the height of a panel on it (units).
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 180.0;

/// Runs in panels, one for each of their columns.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sheet {
    /// What it shows: scene and method.
    pub title: String,
    /// The names of the runs; with more than one there is a legend.
    pub runs: Vec<String>,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
}

/// A panel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Panel {
    /// The titles of the axes, with units.
    pub axes: [String; 2],
    /// The points of each run.
    pub curves: Vec<Vec<[f64; 2]>>,
    /// Whether the upright axis shows sizes, in decades.
    pub decades: bool,
    /// Whether both axes are lengths, and as long: a path from above.
    pub path: bool,
}

/// What a sheet is drawn on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paper {
    /// Width and height (cm).
    pub size: [f64; 2],
    /// Pixels to an inch, of a format that has pixels.
    pub dpi: f64,
}

impl Paper {
    /// Width and height in pixels, of a format that has them.
    #[must_use]
    pub fn pixels(&self) -> [f64; 2] {
        self.size.map(|length| (length / CENTIMETRES_PER_INCH * self.dpi).round())
    }
}

/// A sheet as the bytes of a file.
///
/// # Errors
/// [`ReportError::Draw`] if a PNG would have more than [`MOST_PIXELS`](super::MOST_PIXELS).
pub fn sheet(sheet: &Sheet, paper: &Paper, format: FigureFormat) -> Result<Vec<u8>, ReportError> {
    let size = paper.size.map(|length| length / CENTIMETRES_PER_INCH * UNITS_PER_INCH);
    let low = Grid::of(size, &sheet.panels).cell[1] / LOWEST;
    let scale = low.clamp(SMALLEST, 1.0);
    let [width, height] = size.map(|length| length / scale);
    draw(sheet, width, Some(height)).bytes(format, paper.dpi, scale)
}

/// A sheet as a picture of a page: its panels below each other.
pub(crate) fn column(sheet: &Sheet, file: String) -> Figure {
    Figure { file, caption: format!("{}: against time.", sheet.title), ..draw(sheet, WIDTH, None) }
}

/// Draws a sheet of that width, and of that height unless it has one column.
fn draw(sheet: &Sheet, width: f64, height: Option<f64>) -> Figure {
    let mut figure = Figure { title: sheet.title.clone(), ..Figure::default() };
    let title = label(&sheet.title, (width / text_width("x", SIZE)) as usize);
    figure.canvas.text(&title, [10.0, 0.5 * HEADING], Anchor::Left, SIZE + 1.0);
    let runs = sheet.runs.iter().enumerate().filter(|_| sheet.runs.len() > 1);
    let entries: Vec<LegendEntry<'_>> = runs.map(|(run, name)| (Ink::Method(run), name.as_str())).collect();
    let legend = figure.legend(&entries, width, HEADING);
    let (top, count) = (HEADING + if legend > 0.0 { legend + 8.0 } else { 0.0 }, sheet.panels.len());
    let grid = match height {
        Some(height) => Grid::of([width, height - top], &sheet.panels),
        None => Grid { columns: 1, count, cell: [width, HEIGHT], wide: false },
    };
    figure.size = [width, height.unwrap_or(top + HEIGHT * count as f64)];
    for (panel, ([x, y], size)) in sheet.panels.iter().zip(grid.places()) {
        panel.draw(&mut figure, [x, top + y], size);
    }
    figure
}

/// How a sheet is divided.
struct Grid {
    columns: usize,
    count: usize,
    /// The size of a cell (units).
    cell: [f64; 2],
    /// The first panel, a path, has the cell that would be left over.
    wide: bool,
}

impl Grid {
    /// The division of which a cell has the ratio nearest to the one that it should have.
    fn of([width, height]: [f64; 2], panels: &[Panel]) -> Self {
        let count = panels.len();
        let divided = |columns: usize| {
            let rows = count.div_ceil(columns).max(1);
            let wide = rows * columns == count + 1 && columns > 1 && panels.first().is_some_and(|panel| panel.path);
            Self { columns, count, cell: [width / columns as f64, height.max(1.0) / rows as f64], wide }
        };
        let off = |grid: &Self| (grid.cell[0] / grid.cell[1] / RATIO).ln().abs();
        let all = (1..=count.clamp(1, 6)).map(divided);
        all.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or_else(|| divided(1))
    }

    /// The upper left corner and the size of each panel.
    fn places(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let [width, height] = self.cell;
        (0..self.count).map(move |k| {
            let cell = k + usize::from(self.wide && k > 0);
            let corner = [(cell % self.columns) as f64 * width, (cell / self.columns) as f64 * height];
            (corner, [if self.wide && k == 0 { 2.0 * width } else { width }, height])
        })
    }
}

impl Panel {
    fn draw(&self, figure: &mut Figure, [left, top]: [f64; 2], [width, height]: [f64; 2]) {
        let scale = if self.decades { Scale::Decades(FLOOR) } else { Scale::Plain };
        let curves: Vec<Cow<'_, [[f64; 2]]>> = self.curves.iter().map(|points| self.shown(points)).collect();
        let nothing = Span { lo: 0.0, hi: 1.0 };
        let mut x = Span::of(self.curves.iter().flatten().map(|point| point[0])).unwrap_or(nothing);
        let heights = curves.iter().flat_map(|points| points.iter()).filter(|point| drawable(point[0]));
        let mut y = Span::of(heights.map(|point| scale.of(point[1]))).unwrap_or(nothing);
        let height = (height - ABOVE - BELOW).max(SHORTEST);
        y = if self.decades { whole_decades(y, 0.0) } else { Span::about(y.middle(), 1.06 * y.visible()) };
        let upwards = |y: Span| match self.decades {
            true => decades(y, (height / 24.0).max(2.0), 0.0),
            false => ticks(y, height / 34.0, height / 18.0),
        };
        let margin_of = (margin(&upwards(y)) + 2.0 * TITLE).min((width - BESIDE - SHORTEST).max(0.0));
        let width = (width - margin_of - BESIDE).max(SHORTEST.min(width));
        if self.path {
            // A metre is as long upwards as across.
            let unit = (1.06 * x.visible() / width).max(1.06 * y.visible() / height);
            x = Span::about(x.middle(), unit * width);
            y = Span::about(y.middle(), unit * height);
        } else if x.visible() > x.half() {
            x = Span::about(x.middle(), x.visible());
        }
        let figures = margin(&linear(x, 5.0));
        let across = ticks(x, (width / (1.5 * figures)).min(7.0), width / (1.1 * figures));
        let axis = |span, scale, ticks| Axis { name: String::new(), span, scale, ticks };
        let axes = [axis(x, Scale::Plain, across), axis(y, scale, upwards(y))];
        let distance = margin(&axes[1].ticks) + 0.4 * TITLE;
        figure.axes([left + margin_of, top + ABOVE, width, height], axes.each_ref());
        figure.titles(self.axes.each_ref().map(String::as_str), distance);
        let pen = if curves.len() > 1 { 1.4 } else { 1.2 };
        for (run, points) in curves.iter().enumerate() {
            figure.line(&figure.places(points), Some(POINTS), (Ink::Method(run), 1.0, pen));
        }
        let start = curves.first().and_then(|points| figure.places(points).into_iter().flatten().next());
        if let Some(start) = start.filter(|_| self.path) {
            figure.canvas.marker(0, start);
        }
    }

    /// The points to draw: as they are, or the largest sizes in short stretches of time.
    fn shown<'a>(&self, points: &'a [[f64; 2]]) -> Cow<'a, [[f64; 2]]> {
        if !self.decades {
            return Cow::Borrowed(points);
        }
        let [time, values] = [0, 1].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<_>>());
        // A stretch without a value is a gap.
        peaks(&time, &values, PEAKS).into_iter().map(|peak| peak.unwrap_or([f64::NAN; 2])).collect()
    }
}

/// About `wanted` ticks, and where these are fewer than three, as many as there is room for.
fn ticks(span: Span, wanted: f64, room: f64) -> Vec<Tick> {
    let tried = (0..8).map(|k| linear(span, wanted.max(1.5) * 1.3_f64.powi(k)));
    let mut best = Vec::new();
    for ticks in tried.take_while(|ticks| ticks.len() as f64 <= room.max(2.0)) {
        if best.len() < 3 && ticks.len() > best.len() {
            best = ticks;
        }
    }
    best
}
