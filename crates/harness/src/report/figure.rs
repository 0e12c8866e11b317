//! A figure for a paper: columns of runs against time, and their paths, with the titles of axes where journals have them.

use super::ReportError;
use super::axis::{self, LegendEntry, SIZE, Tick};
use super::canvas::{Anchor, Canvas, Drawn, Ink, text_width};
use super::geometry::{PlotFrame, Span, drawable, visible};
use super::picture::{FigureFormat, Picture, UNITS_PER_INCH};
use super::thinning::{peaks, thin};
use super::xml::label;

const CENTIMETRES_PER_INCH: f64 = 2.54;
/// So many points of a curve at most, and of one on a logarithmic axis, each the largest of a stretch.
const POINTS: usize = 2000;
const PEAKS: usize = 120;
/// Room below the frame of a panel, above it and to the right; and between figures and title of an upright axis.
const BELOW: f64 = 44.0;
const ABOVE: f64 = 10.0;
const BESIDE: f64 = 16.0;
const TITLE: f64 = 12.0;
/// The height of the figure's title.
const HEADING: f64 = 26.0;
/// The ratio of width to height that a panel should have.
const RATIO: f64 = 1.6;
/// A panel that is lower than this (units) has smaller letters and lines, down to a part of their size.
const LOWEST: f64 = 165.0;
const SMALLEST: f64 = 0.65;
/// Sizes below this are shown at it: they are the rounding of numbers near 1.
const FLOOR: f64 = 1e-16;

/// Runs in panels, one for each of their columns.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figure {
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

/// What a figure is drawn on.
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

/// A figure as the bytes of a file.
///
/// # Errors
/// [`ReportError::Draw`] if the drawing library fails.
pub fn figure(figure: &Figure, paper: &Paper, format: FigureFormat) -> Result<Vec<u8>, ReportError> {
    let size = paper.size.map(|length| length / CENTIMETRES_PER_INCH * UNITS_PER_INCH);
    let low = FigureCells::of(size, &figure.panels).size[1] / LOWEST;
    let scale = low.clamp(SMALLEST, 1.0);
    draw(figure, "figure".to_owned(), String::new(), size.map(|length| length / scale))?.bytes(format, paper.dpi, scale)
}

/// The width of a picture of a page, and the height of a panel on it (units).
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 180.0;

/// A figure as a picture of a page: its panels below each other.
pub(super) fn column(figure: &Figure, file: String) -> Result<Picture, ReportError> {
    let size = [WIDTH, HEADING + HEIGHT * figure.panels.len() as f64];
    let caption = format!("{}: against time.", figure.title);
    let cells = FigureCells { columns: 1, count: figure.panels.len(), size: [WIDTH, HEIGHT], wide: false };
    drawn(figure, file, caption, size, &cells)
}

/// Draws a figure of that size (units).
fn draw(figure: &Figure, file: String, caption: String, size: [f64; 2]) -> Result<Picture, ReportError> {
    let [width, height] = size;
    let cells = FigureCells::of([width, height - above(figure, width)], &figure.panels);
    drawn(figure, file, caption, size, &cells)
}

/// The legend of a figure.
fn entries(figure: &Figure) -> Vec<LegendEntry<'_>> {
    match figure.runs.len() {
        0 | 1 => Vec::new(),
        _ => figure.runs.iter().enumerate().map(|(run, name)| (Ink::Method(run), name.as_str())).collect(),
    }
}

/// The room above the panels: title and legend.
fn above(figure: &Figure, width: f64) -> f64 {
    let (_, legend) = axis::legend(&entries(figure), width - 20.0);
    HEADING + if legend > 0.0 { legend + 8.0 } else { 0.0 }
}

fn drawn(
    figure: &Figure,
    file: String,
    caption: String,
    size: [f64; 2],
    cells: &FigureCells,
) -> Result<Picture, ReportError> {
    let width = size[0];
    let (entries, top) = (entries(figure), above(figure, width));
    let (places, _) = axis::legend(&entries, width - 20.0);
    let title = label(&figure.title, (width / text_width("x", SIZE)) as usize);
    Picture::draw(file, figure.title.clone(), caption, size, |canvas| {
        canvas.text(&title, [10.0, 0.5 * HEADING], Anchor::Left, SIZE + 1.0)?;
        axis::draw_legend(canvas, &entries, &places, [10.0, HEADING])?;
        for (panel, ([x, y], size)) in figure.panels.iter().zip(cells.places()) {
            Placed::of(panel, [x, top + y], size).draw(canvas)?;
        }
        Ok(())
    })
}

/// How a sheet is divided.
struct FigureCells {
    columns: usize,
    count: usize,
    /// Of a cell (units).
    size: [f64; 2],
    /// The first panel, a path, has the cell that would be left over.
    wide: bool,
}

impl FigureCells {
    /// The division of which a cell has the ratio nearest to the one that it should have.
    fn of([width, height]: [f64; 2], panels: &[Panel]) -> Self {
        let count = panels.len();
        let divided = |columns: usize| {
            let rows = count.div_ceil(columns).max(1);
            let wide = rows * columns == count + 1 && columns > 1 && panels.first().is_some_and(|panel| panel.path);
            Self { columns, count, size: [width / columns as f64, height.max(1.0) / rows as f64], wide }
        };
        let off = |cells: &Self| (cells.size[0] / cells.size[1] / RATIO).ln().abs();
        let all = (1..=count.clamp(1, 6)).map(divided);
        all.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or_else(|| divided(1))
    }

    /// The upper left corner and the size of each panel.
    fn places(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let [width, height] = self.size;
        (0..self.count).map(move |k| {
            let cell = k + usize::from(self.wide && k > 0);
            let corner = [(cell % self.columns) as f64 * width, (cell / self.columns) as f64 * height];
            (corner, [if self.wide && k == 0 { 2.0 * width } else { width }, height])
        })
    }
}

/// A panel with its place on the sheet.
struct Placed<'a> {
    panel: &'a Panel,
    frame: PlotFrame,
    ticks: [Vec<Tick>; 2],
    /// What is drawn: of a panel of decades, the logarithms of peaks.
    curves: Vec<Vec<Option<[f64; 2]>>>,
}

impl<'a> Placed<'a> {
    fn of(panel: &'a Panel, corner: [f64; 2], size: [f64; 2]) -> Self {
        let curves: Vec<_> = panel.curves.iter().map(|points| shown(points, panel.decades)).collect();
        let nothing = Span { lo: 0.0, hi: 1.0 };
        let mut x = Span::of(panel.curves.iter().flatten().map(|point| point[0])).unwrap_or(nothing);
        let mut y = Span::of(curves.iter().flatten().flatten().map(|point| point[1])).unwrap_or(nothing);
        let height = (size[1] - ABOVE - BELOW).max(20.0);
        y = match panel.decades {
            true => Span { lo: y.lo.floor(), hi: y.hi.ceil().max(y.lo.floor() + 1.0) },
            false => Span::about(y.middle(), 1.06 * wide(y)),
        };
        let upwards = |y: Span| match panel.decades {
            true => axis::decades(y, (height / 24.0).max(2.0)),
            false => ticks(y, height / 34.0, height / 18.0),
        };
        let margin = axis::margin(&upwards(y)) + 2.0 * TITLE;
        let width = (size[0] - margin - BESIDE).max(20.0);
        if panel.path {
            // A metre is as long upwards as across.
            let unit = (1.06 * wide(x) / width).max(1.06 * wide(y) / height);
            x = Span::about(x.middle(), unit * width);
            y = Span::about(y.middle(), unit * height);
        } else if wide(x) > x.half() {
            x = Span::about(x.middle(), wide(x));
        }
        let frame = PlotFrame { left: corner[0] + margin, top: corner[1] + ABOVE, width, height, x, y };
        let figures = axis::margin(&axis::linear(x, 5.0));
        let across = ticks(x, (width / (1.5 * figures)).min(7.0), width / (1.1 * figures));
        Self { panel, frame, ticks: [across, upwards(y)], curves }
    }

    fn draw(&self, canvas: &Canvas<'_>) -> Drawn {
        let Self { panel, frame, ticks: [across, up], curves } = self;
        let distance = axis::margin(up) + 0.4 * TITLE;
        axis::titled(canvas, frame, [across, up], [&panel.axes[0], &panel.axes[1]], distance)?;
        let width = if curves.len() > 1 { 1.4 } else { 1.2 };
        for (run, points) in curves.iter().enumerate() {
            let lines = frame.lines(points.iter().map(|point| point.and_then(|point| frame.place(point))));
            for line in thin(lines, POINTS) {
                canvas.line(&line, Ink::Method(run), 1.0, width)?;
            }
        }
        if panel.path
            && let Some(start) = curves.first().and_then(|points| points.iter().flatten().next())
            && let Some([x, y]) = frame.place(*start)
        {
            canvas.marker(0, [x, y])?;
        }
        Ok(())
    }
}

/// About `wanted` ticks, and where these are fewer than three, as many as there is room for.
fn ticks(span: Span, wanted: f64, room: f64) -> Vec<Tick> {
    let tried = (0..8).map(|k| axis::linear(span, wanted.max(1.5) * 1.3_f64.powi(k)));
    let fitting = tried.take_while(|ticks| ticks.len() as f64 <= room.max(2.0));
    let mut best = Vec::new();
    for ticks in fitting {
        if best.len() < 3 && ticks.len() > best.len() {
            best = ticks;
        }
    }
    best
}

/// Half an extent to draw.
fn wide(span: Span) -> f64 {
    visible(span.half(), span.lo.abs().max(span.hi.abs()))
}

/// The points to draw: as they are, or the logarithms of the largest sizes in short stretches of time.
fn shown(points: &[[f64; 2]], decades: bool) -> Vec<Option<[f64; 2]>> {
    if !decades {
        return points.iter().map(|point| point.iter().all(|x| drawable(*x)).then_some(*point)).collect();
    }
    let [time, values] = [0, 1].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<_>>());
    let peaks = peaks(&time, &values, PEAKS).into_iter();
    peaks.map(|peak| peak.map(|[t, size]| [t, size.max(FLOOR).log10()])).collect()
}
