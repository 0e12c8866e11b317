//! A chart of lines, dots or cells over two axes.

use super::canvas::{Anchor, Point, Shape};
use super::figure::{Axis, Figure, LegendEntry, SIZE};
use super::frame::{Scale, Span, drawable};
use super::look::{self, Ink};
use super::ticks::{decades, linear, margin};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 420.0;
/// Maximum number of points of a curve.
const POINTS: usize = 1000;
/// Number of colours of dots: the methods' colours that stand out on white and on black.
const DOTS: usize = 6;
/// The map viridis: its lightness grows evenly, so that any eye, and a grey print, can order its colours.
const COLOURS: [&str; 16] = [
    "#440154", "#481a6c", "#472f7d", "#414487", "#39568c", "#31688e", "#2a788e", "#23888e", "#1f988b", "#22a884",
    "#35b779", "#54c568", "#7ad151", "#a5db36", "#d2e21b", "#fde725",
];
/// Room between the frame and the bar of the colours, and the width of the bar.
const BESIDE: f64 = 16.0;
const BAR: f64 = 14.0;

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// The names of the axes, with units.
    pub axes: [String; 2],
    /// Whether the axis across, and the upright one, shows decades.
    pub decades: [bool; 2],
    /// What is drawn, one over the other.
    pub layers: Vec<Layer>,
}

/// Something on a chart.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// Curves of one kind, with its name in the legend; a curve of one point is a marker.
    Curves {
        /// The name.
        label: String,
        /// The points of each.
        curves: Vec<Vec<[f64; 2]>>,
    },
    /// Dots, each layer in a colour of its own, as far as there are colours.
    Dots(Vec<[f64; 2]>),
    /// Coloured cells.
    Cells(Cells),
}

/// Values over a grid as coloured cells, with a bar that tells what the colours mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// What the colours show, with its unit.
    pub label: String,
    /// The ends of the range across and upwards.
    pub ranges: [[f64; 2]; 2],
    /// The number of columns.
    pub columns: usize,
    /// The values row by row from the lowest row on, each from the left; a cell without one stays empty.
    pub values: Vec<Option<f64>>,
}

/// A chart as the text of an SVG file.
#[must_use]
pub fn chart_svg(chart: &Chart) -> String {
    let scales = chart.decades.map(|decades| if decades { Scale::Decades(f64::NEG_INFINITY) } else { Scale::Plain });
    let (mut points, mut legend): (Vec<[f64; 2]>, Vec<LegendEntry<'_>>) = (Vec::new(), Vec::new());
    let mut grid = None;
    for (number, layer) in chart.layers.iter().enumerate() {
        match layer {
            Layer::Curves { label, curves } => {
                points.extend(curves.iter().flatten());
                legend.push((Ink::Method(number), label));
            }
            Layer::Dots(dots) => points.extend(dots),
            Layer::Cells(cells) => {
                let [[left, right], [low, high]] = cells.ranges;
                points.extend([[left, low], [right, high]]);
                grid = Some(cells);
            }
        }
    }
    let shown = points.into_iter().map(|point| [0, 1].map(|axis| scales[axis].of(point[axis])));
    let shown: Vec<[f64; 2]> = shown.filter(|point| point.iter().all(|x| drawable(*x))).collect();
    let axis = |axis: usize, most: f64| {
        let span = Span::of(shown.iter().map(|point| point[axis])).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        // Dots are not to touch the edge; cells fill the frame.
        let span = Span::about(span.middle(), if grid.is_some() { 1.0 } else { 1.03 } * span.visible());
        let ticks = if chart.decades[axis] { decades(span, 1.5 * most, 0.0) } else { linear(span, most) };
        Axis { name: chart.axes[axis].clone(), span, scale: scales[axis], ticks }
    };
    let axes = [axis(0, 7.0), axis(1, 8.0)];
    let room = [margin(&axes[1].ticks).max(44.0), if grid.is_some() { 84.0 } else { 24.0 }];
    let mut figure = Figure::new(&legend, [WIDTH, HEIGHT], room, axes);
    for (number, layer) in chart.layers.iter().enumerate() {
        let Layer::Curves { curves, .. } = layer else { continue };
        for curve in curves {
            match &figure.places(curve)[..] {
                [place] => place.iter().for_each(|place| figure.canvas.marker(number, *place)),
                places => figure.line(places, Some(POINTS), (Ink::Method(number), 0.9, look::width(1))),
            }
        }
    }
    if let Some(cells) = grid {
        cells.draw(&mut figure);
    }
    for (number, layer) in chart.layers.iter().enumerate() {
        if let Layer::Dots(dots) = layer {
            let places = figure.places(dots).into_iter().flatten().collect();
            let colour = Ink::Method(number % DOTS).colour();
            figure.canvas.draw(Shape::Dots(places), Ink::Colour(colour), 1.0);
        }
    }
    figure.named(String::new(), chart.title.clone(), String::new()).svg(1.0)
}

impl Cells {
    fn draw(&self, figure: &mut Figure) {
        let (frame, columns) = (figure.frame, self.columns.max(1));
        let span = Span::of(self.values.iter().flatten().copied()).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        // The range of the colours begins at zero where nothing is below.
        let lo = span.lo.min(0.0);
        let range = if span.hi > lo { span.hi - lo } else { 1.0 };
        let counts = [self.columns.max(1), (self.values.len() / columns).max(1)];
        let edge = |axis: usize, k: usize| {
            let [lo, hi] = self.ranges[axis];
            lo + (hi - lo) * k as f64 / counts[axis] as f64
        };
        let mut cells: Vec<Vec<[Point; 2]>> = vec![Vec::new(); COLOURS.len()];
        for (place, value) in self.values.iter().enumerate() {
            let Some(value) = value.filter(|value| value.is_finite()) else { continue };
            let corner = |k: usize| frame.place([edge(0, place % columns + k), edge(1, place / columns + k)]);
            let (Some(low), Some(high)) = (corner(0), corner(1)) else { continue };
            let shade = (value - lo) / range * COLOURS.len() as f64;
            cells[(shade as usize).min(COLOURS.len() - 1)].push([low, high]);
        }
        for (colour, cells) in COLOURS.into_iter().zip(cells).filter(|(_, cells)| !cells.is_empty()) {
            figure.canvas.draw(Shape::Cells(cells), Ink::Colour(colour), 1.0);
        }
        let [left, right] = [frame.right() + BESIDE, frame.right() + BESIDE + BAR];
        let up = |share: f64| frame.bottom() - share * frame.height;
        for (k, colour) in COLOURS.into_iter().enumerate() {
            let [low, high] = [k, k + 1].map(|k| up(k as f64 / COLOURS.len() as f64));
            figure.canvas.draw(Shape::Cells(vec![[[left, low], [right, high]]]), Ink::Colour(colour), 1.0);
        }
        for (value, text) in linear(Span { lo, hi: lo + range }, 6.0) {
            let y = up((value - lo) / range);
            figure.canvas.line([[right, y], [right + 4.0, y]], Ink::Text, 0.55, 1.0);
            figure.canvas.text(&text, [right + 8.0, y], Anchor::Left, SIZE);
        }
        figure.canvas.text(&self.label, [right + 44.0, frame.top - 17.0], Anchor::Right, SIZE);
    }
}
