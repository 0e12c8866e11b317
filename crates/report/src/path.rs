//! The picture of the paths, seen from above.

use super::figure::{Axis, Figure, LegendEntry, Pen};
use super::frame::{Scale, Span, drawable, visible};
use super::look::{self, Ink};
use super::sleigh::{APART, sleighs};
use super::ticks::{across, linear, margin};
use super::{Body, SceneReport};

const WIDTH: f64 = 560.0;
/// Room beside the frame.
const RIGHT: f64 = 16.0;
/// Room for what lies at the edge of the paths: half a sleigh.
const PADDING: f64 = 24.0;
/// How many points of a path are kept.
const POINTS: usize = 4000;
/// How many times larger than the exact path the picture may become because of a method that leaves it.
const STRAY: f64 = 2.5;

/// Draws the picture of a scene.
pub(crate) fn picture(scene: &SceneReport, name: &str) -> Figure {
    let mut legend = scene.legend();
    let exact = scene.exact();
    legend.extend(exact.map(|_| (Ink::Exact, "exact")));
    let mut figure = view(scene, &legend);
    path(&mut figure, exact.unwrap_or_default(), (Ink::Exact, 0.7, 1.3));
    let places: Vec<_> = scene.series.iter().map(|series| figure.places(&series.path)).collect();
    for (method, series) in scene.series.iter().enumerate() {
        path(&mut figure, &series.path, (Ink::Method(method), 1.0, look::width(method)));
    }
    for (method, places) in places.iter().enumerate() {
        figure.markers(places, method, scene.series.len(), 5, APART);
    }
    let frame = figure.frame;
    let inside = |place: &Option<[f64; 2]>| place.filter(|place| frame.holds(*place));
    for (method, places) in places.iter().enumerate().filter(|(method, _)| scene.series[*method].failed) {
        if let Some(place) = places.last().and_then(inside) {
            figure.canvas.cross(method, place);
        }
    }
    let (path, drawn) = match scene.body {
        Body::Sleigh => ("The path of the blade on the ground, seen from above", "The sleigh is drawn"),
        Body::Other => ("The path of (x, y)", "Arrows are drawn"),
    };
    let mut caption = format!("{path}, with the same scale on both axes.");
    if let Some((_, series)) = scene.leading() {
        sleighs(&mut figure.canvas, &frame, scene.body, series);
        caption += &format!(" {drawn} at equally spaced times of the run by {}.", series.label);
    }
    if exact.is_some() {
        caption += " Thin grey dashes: the exact path.";
    }
    caption += &scene.remarks(|method| places[method].iter().any(|place| inside(place).is_none()));
    figure.named(format!("{name}-path"), format!("{}: path from above", scene.title), caption)
}

/// Draws what the frame shows of a path.
pub(crate) fn path(figure: &mut Figure, path: &[[f64; 2]], pen: Pen) {
    figure.line(&figure.places(path), Some(POINTS), pen);
}

/// The ground that the paths of a scene ask for: as high as they are, within reason, and a metre as long upwards as across.
pub(crate) fn view(scene: &SceneReport, legend: &[LegendEntry<'_>]) -> Figure {
    let exact = scene.exact();
    let all = |axis: usize| {
        let paths = scene.scaling().map(|series| series.path.as_slice()).chain(exact);
        let behind = scene.scaling().flat_map(|series| series.followers.iter().flatten());
        let points = paths.flatten().copied().chain(behind.map(|[x, y, _]| [*x, *y]));
        let span = Span::of(points.filter(|[x, y]| drawable(*x) && drawable(*y)).map(|point| point[axis]));
        span.unwrap_or(Span { lo: -1.0, hi: 1.0 })
    };
    let [x, y] = exact.map_or([all(0), all(1)], |path| near(path, [all(0), all(1)]));
    let largest = [x.lo, x.hi, y.lo, y.hi].into_iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let half = visible(x.half().max(y.half()), largest);
    let (half_x, half_y) = if x.half().max(y.half()) < half { (half, 0.0) } else { (x.half(), y.half()) };
    // The room for the figures depends on the ticks, and these on the height, but hardly: once is enough.
    let left = margin(&linear(Span::about(y.middle(), half), 5.0)).max(44.0);
    let width = WIDTH - left - RIGHT;
    let ratio = half_y / half_x.max(1e-3 * half);
    let height = ((width - 2.0 * PADDING) * ratio + 2.0 * PADDING).clamp(0.26 * width, 0.8 * width);
    let metre = (2.0 * half_x / (width - 2.0 * PADDING)).max(2.0 * half_y / (height - 2.0 * PADDING));
    let [x, y] = [(x, width), (y, height)].map(|(span, length)| Span::about(span.middle(), 0.5 * length * metre));
    let axis = |name: &str, span, ticks| Axis { name: name.to_owned(), span, scale: Scale::Plain, ticks };
    let across = axis("x [m]", x, across(x, width, 7.0));
    let up = axis("y [m]", y, linear(y, (height / 55.0).max(3.5)));
    Figure::new(legend, [WIDTH, height], [left, RIGHT], [across, up])
}

/// Keeps a method that goes astray from making a dot of everything else.
fn near(exact: &[[f64; 2]], all: [Span; 2]) -> [Span; 2] {
    let [Some(x), Some(y)] = [0, 1].map(|axis| Span::of(exact.iter().map(|point| point[axis]))) else { return all };
    let half = x.half().max(y.half());
    if half <= 0.0 {
        return all;
    }
    let reach = |span: Span, wanted: Span| wanted.within(Span::about(span.middle(), STRAY * half));
    [reach(x, all[0]), reach(y, all[1])]
}
