//! A chart of lines, dots or cells over two axes.

use super::axis::{self, LegendEntry};
use super::canvas::{Ink, units};
use super::cells::Cells;
use super::geometry::{PlotFrame, Span, drawable, visible};
use super::picture::Picture;
use super::thinning::thin;
use super::{ReportError, look};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 420.0;
/// So many points of a curve at most.
const POINTS: usize = 1000;
/// The colours of dots: those of methods that stand out on white and on black.
const DOTS: usize = 6;

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

/// A chart as the text of an SVG file.
///
/// # Errors
/// [`ReportError::Draw`] if the drawing library fails.
pub fn chart_svg(chart: &Chart) -> Result<String, ReportError> {
    let scaled =
        |point: [f64; 2]| [0, 1].map(|axis| if chart.decades[axis] { point[axis].log10() } else { point[axis] });
    let (mut points, mut entries): (Vec<[f64; 2]>, Vec<LegendEntry<'_>>) = (Vec::new(), Vec::new());
    let mut cells = None;
    for (number, layer) in chart.layers.iter().enumerate() {
        match layer {
            Layer::Curves { label, curves } => {
                points.extend(curves.iter().flatten());
                entries.push((Ink::Method(number), label));
            }
            Layer::Dots(dots) => points.extend(dots),
            Layer::Cells(grid) => {
                let [x, y] = grid.ranges;
                points.extend([[x[0], y[0]], [x[1], y[1]]]);
                cells = Some(grid);
            }
        }
    }
    let points: Vec<[f64; 2]> = points.into_iter().map(scaled).filter(|p| p.iter().all(|x| drawable(*x))).collect();
    // Dots are not to touch the edge; cells fill the frame.
    let span = |axis: usize| {
        let span = Span::of(points.iter().map(|point| point[axis])).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        let half = visible(span.half(), span.lo.abs().max(span.hi.abs()));
        Span::about(span.middle(), if cells.is_some() { half } else { 1.03 * half })
    };
    let (x, y) = (span(0), span(1));
    let (places, legend) = axis::legend(&entries, WIDTH - 20.0);
    let [across, up] = [(0, x, 7.0), (1, y, 8.0)].map(|(axis, span, wanted)| {
        if chart.decades[axis] { axis::decades(span, 1.5 * wanted) } else { axis::linear(span, wanted) }
    });
    let left = axis::margin(&up).max(44.0);
    let right = if cells.is_some() { 84.0 } else { 24.0 };
    let frame = PlotFrame { left, top: legend + 34.0, width: WIDTH - left - right, height: HEIGHT, x, y };
    let file = "chart.svg".to_owned();
    let picture = Picture::draw(file, chart.title.clone(), String::new(), [WIDTH, frame.bottom() + 44.0], |canvas| {
        axis::draw_legend(canvas, &entries, &places, [10.0, 4.0])?;
        axis::draw(canvas, &frame, [&across, &up], [&chart.axes[0], &chart.axes[1]])?;
        for (number, layer) in chart.layers.iter().enumerate() {
            let Layer::Curves { curves, .. } = layer else { continue };
            for curve in curves {
                let mut places = curve.iter().map(|point| frame.place(scaled(*point)));
                if curve.len() == 1 {
                    places.next().flatten().map_or(Ok(()), |place| canvas.marker(number, place))?;
                } else {
                    for line in thin(frame.lines(places), POINTS) {
                        canvas.line(&line, Ink::Method(number), 0.9, look::width(1))?;
                    }
                }
            }
        }
        cells.map_or(Ok(()), |cells| cells.figures(canvas, &frame))
    })?;
    let mut shapes = cells.map_or_else(String::new, |cells| cells.shapes(&frame) + &cells.bar(&frame));
    for (number, layer) in chart.layers.iter().enumerate() {
        if let Layer::Dots(dots) = layer {
            let places = dots.iter().filter_map(|dot| frame.place(scaled(*dot)));
            shapes += &dotted(places, look::colour(number % DOTS));
        }
    }
    Ok(picture.with(&shapes).standalone())
}

/// All dots of a colour as one path of lines without length, whose round ends are the dots.
fn dotted(places: impl Iterator<Item = [f64; 2]>, colour: &str) -> String {
    let path: String = places.map(|place| place.map(units)).map(|[x, y]| format!("M{x} {y}h0")).collect();
    format!("<path stroke=\"{colour}\" stroke-width=\"{}\" stroke-linecap=\"round\" d=\"{path}\"/>\n", units(1.7))
}
