//! The picture of the paths, seen from above.

use super::axis;
use super::canvas::{Canvas, Drawn, Ink};
use super::geometry::{PlotFrame, Span, distance, drawable, visible};
use super::look;
use super::picture::Picture;
use super::sleigh::{APART, sleighs};
use super::thinning::thin;
use super::{ReportError, SceneReport, Series, entries, failures, leading, scaling};

const WIDTH: f64 = 560.0;
/// Room beside the frame.
pub(super) const RIGHT: f64 = 16.0;
/// Room for what lies at the edge of the paths: half a sleigh.
const PADDING: f64 = 24.0;
/// How many points of a path are kept.
const POINTS: usize = 4000;
/// How many times larger than the exact path the picture may become because of a method that leaves it.
const STRAY: f64 = 2.5;

/// Draws the picture of a scene.
pub(super) fn picture(scene: &SceneReport, name: &str) -> Result<Picture, ReportError> {
    let mut entries = entries(scene);
    let exact = scene.exact_path.as_deref().filter(|path| !path.is_empty());
    if exact.is_some() {
        entries.push((Ink::Exact, "exact"));
    }
    let (places, legend) = axis::legend(&entries, WIDTH - 20.0);
    let view = view(scene, legend + 34.0);
    let frame = &view.frame;
    let caption = caption(scene, exact.is_some(), &strays(scene, frame));
    let size = [WIDTH, frame.bottom() + 44.0];
    Picture::draw(format!("{name}-path"), format!("{}: path from above", scene.title), caption, size, |canvas| {
        axis::draw_legend(canvas, &entries, &places, [10.0, 4.0])?;
        view.axes(canvas)?;
        view.line(canvas, exact.unwrap_or_default(), Ink::Exact, 0.7, 1.3)?;
        for (method, series) in scene.series.iter().enumerate() {
            view.line(canvas, &series.path, Ink::Method(method), 1.0, look::width(method))?;
        }
        for (method, series) in scene.series.iter().enumerate() {
            markers(canvas, frame, method, series, scene.series.len())?;
        }
        for (method, series) in scene.series.iter().enumerate().filter(|(_, series)| series.failed) {
            let last = series.path.last().and_then(|point| frame.place(*point));
            last.filter(|place| frame.holds(*place)).map_or(Ok(()), |place| canvas.cross(method, place))?;
        }
        leading(scene).map_or(Ok(()), |(_, series)| sleighs(canvas, frame, series))
    })
}

/// The ground seen from above.
pub(super) struct PathView {
    pub(super) frame: PlotFrame,
    ticks: [Vec<axis::Tick>; 2],
}

/// The view that the paths of a scene ask for, with so much room above.
pub(super) fn view(scene: &SceneReport, top: f64) -> PathView {
    let frame = frame(scene, scene.exact_path.as_deref().filter(|path| !path.is_empty()), top);
    PathView { frame, ticks: ticks(&frame) }
}

impl PathView {
    pub(super) fn axes(&self, canvas: &Canvas<'_>) -> Drawn {
        let [across, up] = &self.ticks;
        axis::draw(canvas, &self.frame, [across, up], ["x [m]", "y [m]"])
    }

    pub(super) fn line(&self, canvas: &Canvas<'_>, path: &[[f64; 2]], ink: Ink, opacity: f64, width: f64) -> Drawn {
        thinned(&self.frame, path).iter().try_for_each(|line| canvas.line(line, ink, opacity, width))
    }
}

/// What the frame shows of a path, in unbroken lines of not too many points.
fn thinned(frame: &PlotFrame, path: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    thin(frame.lines(path.iter().map(|point| frame.place(*point))), POINTS)
}

fn caption(scene: &SceneReport, exact: bool, strays: &[&str]) -> String {
    let mut caption =
        "The path of the blade on the ground, seen from above, with the same scale on both axes.".to_owned();
    if let Some((_, series)) = leading(scene) {
        caption += &format!(" The sleigh is drawn at equally spaced times of the run by {}.", series.label);
    }
    if exact {
        caption += " Thin grey dashes: the exact path.";
    }
    if !strays.is_empty() {
        caption += &format!(" Curves that leave the picture: {}.", strays.join(", "));
    }
    caption + &failures(scene)
}

/// The methods whose path leaves the picture.
fn strays<'a>(scene: &'a SceneReport, frame: &PlotFrame) -> Vec<&'a str> {
    let outside = |point: &[f64; 2]| !frame.place(*point).is_some_and(|place| frame.holds(place));
    let stray = scene.series.iter().filter(|series| series.path.iter().any(outside));
    stray.map(|series| series.label.as_str()).collect()
}

/// The frame: as high as the paths ask for, within reason, and a metre as long upwards as across.
fn frame(scene: &SceneReport, exact: Option<&[[f64; 2]]>, top: f64) -> PlotFrame {
    let all = |axis: usize| {
        let paths = scaling(scene).map(|series| series.path.as_slice()).chain(exact);
        let behind = scaling(scene).flat_map(|series| series.followers.iter().flatten());
        let points = paths.flatten().copied().chain(behind.map(|[x, y, _]| [*x, *y]));
        Span::of(points.filter(|point| drawable(point[0]) && drawable(point[1])).map(|point| point[axis]))
    };
    let spans = [0, 1].map(|axis| all(axis).unwrap_or(Span { lo: -1.0, hi: 1.0 }));
    let spans = exact.map_or(spans, |path| near(path, spans));
    let [x, y] = spans;
    let largest = [x.lo, x.hi, y.lo, y.hi].into_iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let half = visible(x.half().max(y.half()), largest);
    let (half_x, half_y) = if x.half().max(y.half()) < half { (half, 0.0) } else { (x.half(), y.half()) };
    // The room for the figures depends on the ticks, and these on the height, but hardly: once is enough.
    let guess = Span::about(y.middle(), half);
    let left = axis::margin(&axis::linear(guess, 5.0)).max(44.0);
    let width = WIDTH - left - RIGHT;
    let ratio = half_y / half_x.max(1e-3 * half);
    let height = ((width - 2.0 * PADDING) * ratio + 2.0 * PADDING).clamp(0.26 * width, 0.8 * width);
    let metre = (2.0 * half_x / (width - 2.0 * PADDING)).max(2.0 * half_y / (height - 2.0 * PADDING));
    PlotFrame {
        left,
        top,
        width,
        height,
        x: Span::about(x.middle(), 0.5 * width * metre),
        y: Span::about(y.middle(), 0.5 * height * metre),
    }
}

/// Keeps a method that goes astray from making a dot of everything else.
fn near(exact: &[[f64; 2]], all: [Span; 2]) -> [Span; 2] {
    let extent = [0, 1].map(|axis| Span::of(exact.iter().map(|point| point[axis])));
    let [Some(x), Some(y)] = extent else { return all };
    let half = x.half().max(y.half());
    if half <= 0.0 {
        return all;
    }
    let reach = |span: Span, wanted: Span| wanted.within(Span::about(span.middle(), STRAY * half));
    [reach(x, all[0]), reach(y, all[1])]
}

fn ticks(frame: &PlotFrame) -> [Vec<axis::Tick>; 2] {
    let across = axis::linear(frame.x, 6.0);
    // Figures as wide as their distance would run into each other.
    let widest = axis::margin(&across);
    [
        axis::linear(frame.x, (frame.width / (1.4 * widest)).clamp(2.0, 7.0)),
        axis::linear(frame.y, (frame.height / 55.0).max(3.5)),
    ]
}

/// A few markers on a path, at other places for each method.
fn markers(canvas: &Canvas<'_>, frame: &PlotFrame, method: usize, series: &Series, methods: usize) -> Drawn {
    let last = series.path.len().saturating_sub(1) as f64;
    let mut before: Option<[f64; 2]> = None;
    for k in 0..5_u32 {
        let share = (f64::from(k) + (method as f64 + 0.5) / methods as f64) / 5.0;
        let place = series.path.get((share * last).round() as usize).and_then(|point| frame.place(*point));
        if let Some(place) = place.filter(|place| frame.holds(*place))
            && before.is_none_or(|before| distance(before, place) > APART)
        {
            canvas.marker(method, place)?;
            before = Some(place);
        }
    }
    Ok(())
}
