//! The pictures of what should stay zero, against time, on a logarithmic axis.

use super::canvas::{Anchor, Point, text_width};
use super::figure::{Axis, Figure, SIZE};
use super::frame::{Scale, Span};
use super::look::{self, Ink};
use super::svg::label;
use super::thinning::{Trace, peaks};
use super::ticks::{Tick, across, decades, margin, power};
use super::{Body, SceneReport, Series};

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 250.0;
/// How many points of a series are drawn at most: more would lie on top of each other.
const POINTS: usize = 300;
/// How many points a picture has in all, unless its series then had fewer than [`FEWEST`] each.
const TOGETHER: usize = 2000;
/// How many points a series needs for its shape.
const FEWEST: usize = 75;
/// How far apart the names at the ends of the lines are.
const NAMES: f64 = 15.0;
/// The decade of the rounding of numbers near 1.
const ROUNDING: f64 = -16.0;
/// The longest name at the end of a line.
const LONGEST: usize = 17;

/// Decades that the axis covers at most below the usual values of the most exact method: smaller values say only that they are small.
const BELOW: f64 = 8.0;
/// Decades that the axis covers at most above these values: with larger values a method has blown up.
const ABOVE: f64 = 24.0;
/// Decades within which a method counts as exact as the most exact one.
const NEAR: f64 = 1.5;

/// What a picture shows.
pub(crate) struct Drift {
    file: &'static str,
    title: &'static str,
    /// The name of the upright axis, and the caption: of a sleigh, and of any other system.
    axis: [&'static str; 2],
    caption: [&'static str; 2],
    /// The decade below which nothing is more than rounding.
    least: f64,
    values: fn(&Series) -> &Vec<f64>,
}

/// The constraint's residual.
pub(crate) const CONSTRAINT: Drift = Drift {
    file: "constraint",
    title: "constraint residual",
    axis: ["|A(q) v + b|  [m/s]", "|A(q) v + b|"],
    caption: [
        "How fast the blade slips sideways. Around 10⁻¹⁶ there is nothing but rounding: the constraint is kept.",
        "By how much the velocities miss the constraints. Around 10⁻¹⁶ there is nothing but rounding: they are kept.",
    ],
    least: ROUNDING,
    values: |series| &series.constraint,
};

/// The energy error.
pub(crate) const ENERGY: Drift = Drift {
    file: "energy",
    title: "energy error",
    axis: ["|E − E₀ − W|  [J]"; 2],
    caption: [
        "The energy error: the energy less its initial value, and less the work W of whatever drives or \
        brakes the sleigh. A line that keeps climbing is drift.",
        "The energy error: the energy less its initial value, and less the work W of whatever drives or \
        brakes the system. A line that keeps climbing is drift.",
    ],
    least: f64::NEG_INFINITY,
    values: |series| &series.energy_error,
};

/// Draws the picture of a scene.
pub(crate) fn picture(scene: &SceneReport, name: &str, shown: &Drift) -> Figure {
    let values = shown.values;
    let most = (TOGETHER / scene.series.len().max(1)).clamp(FEWEST, POINTS);
    let trace = |series: &Series| peaks(&series.time, values(series), most);
    let traces: Vec<Trace> = scene.series.iter().map(trace).collect();
    let (y, floor) = axis(&scene.scaling().map(trace).collect::<Vec<_>>(), scene.body, shown);
    let legend = scene.legend();
    let names: Vec<String> = scene.series.iter().map(|series| label(&series.label, LONGEST)).collect();
    // More names than fit beside the frame are left to the legend.
    let named = legend.len() as f64 * NAMES <= HEIGHT;
    let right = names.iter().filter(|_| named).map(|name| text_width(name, SIZE)).fold(0.0, f64::max) + 26.0;
    let (left, highest, span) = (margin(&y.ticks), y.span.hi, times(scene));
    let ticks = across(span, WIDTH - left - right, 8.0);
    let x = Axis { name: "t [s]".to_owned(), span, scale: Scale::Plain, ticks };
    let mut figure = Figure::new(&legend, [WIDTH, HEIGHT], [left, right], [x, y]);
    let frame = figure.frame;
    if let Some([_, y]) = floor.as_ref().and_then(|(floor, _)| frame.at([frame.x.lo, *floor])) {
        figure.canvas.line([[frame.left, y], [frame.right(), y]], Ink::Exact, 0.6, 1.0);
    }
    let place = |trace: &Trace| trace.iter().map(|point| frame.place((*point)?)).collect::<Vec<_>>();
    let places: Vec<Vec<Option<Point>>> = traces.iter().map(place).collect();
    for (method, places) in places.iter().enumerate() {
        figure.line(places, None, (Ink::Method(method), 1.0, look::width(method)));
    }
    for (method, line) in places.iter().enumerate() {
        figure.markers(line, method, places.len(), 6, -1.0);
    }
    // Where each line ends; at the edge where it has left the picture upwards.
    let ends = places.iter().enumerate().filter_map(|(method, line)| {
        let [x, y] = line.iter().rev().flatten().next().copied()?;
        Some((method, [x, y.clamp(frame.top, frame.bottom())]))
    });
    let ends: Vec<(usize, Point)> = ends.collect();
    for (method, end) in ends.iter().filter(|(method, _)| scene.series[*method].failed) {
        figure.canvas.cross(*method, *end);
    }
    if named {
        name_ends(&mut figure, ends, &names);
    }
    let longest = scene.series.iter().map(|series| series.time.len().min(values(series).len())).max();
    let mut caption = shown.caption[scene.body as usize].to_owned();
    if longest.is_some_and(|longest| longest > most) {
        caption += " Each point is the largest value of a short stretch of time.";
    }
    if let Some((_, text)) = floor {
        caption += &format!(" Values {} and exact zeros lie on the dashed line.", text.replace("≤ ", "below "));
    }
    let leaves = |[_, size]: &[f64; 2]| size.log10() > highest;
    caption += &scene.remarks(|method| traces[method].iter().flatten().any(leaves));
    figure.named(format!("{name}-{}", shown.file), format!("{}: {} against time", scene.title, shown.title), caption)
}

/// From the first time to the last, also where nothing can be drawn, so that the pictures of a scene match.
fn times(scene: &SceneReport) -> Span {
    let times = scene.series.iter().flat_map(|series| series.time.iter().copied());
    let span = Span::of(times).unwrap_or(Span { lo: 0.0, hi: 1.0 });
    if span.half() < span.visible() { Span { lo: span.lo, hi: span.lo + span.visible() } } else { span }
}

/// The upright axis for these traces: decades, the lowest of which is a line for all that is smaller, or zero; and that line, where something
/// lies on it.
fn axis(traces: &[Trace], body: Body, shown: &Drift) -> (Axis, Option<Tick>) {
    let all: Vec<f64> = traces.iter().flatten().flatten().map(|point| point[1]).collect();
    let best = traces.iter().filter_map(usual).fold(f64::INFINITY, f64::min).log10();
    let worth = |log: &f64| *log >= best - BELOW && *log <= best + ABOVE;
    let logs = Span::of(all.iter().filter(|size| **size > 0.0).map(|size| size.log10()).filter(worth));
    // Where everything is zero, the decades below it show what it is smaller than.
    let Span { lo, hi } = logs.unwrap_or(Span { lo: -17.0, hi: -14.5 });
    // Where the most exact method has zeros, its other values are rounding too: they come and go from node to node.
    let rounds = |trace: &Trace| {
        let near = usual(trace).is_none_or(|size| size.log10() < best + NEAR);
        near && trace.iter().skip(1).flatten().any(|point| point[1] <= 0.0)
    };
    let rounding = (best.is_finite() && traces.iter().any(rounds)).then_some(best.ceil());
    let lo = rounding.unwrap_or((lo + 1e-9).floor()).max(shown.least);
    // The highest peak is not to touch the upper edge.
    let hi = (hi + 0.08).ceil().max(lo + 1.0);
    // A zero has a logarithm that is below all.
    let floor = all.iter().any(|size| size.log10() < lo).then(|| (lo, format!("≤ {}", power(lo))));
    let [below, free] = if floor.is_some() { [0.05 * (hi - lo), 0.5] } else { [0.0; 2] };
    // The floor has a tick of its own.
    let ticks = decades(Span { lo, hi }, 7.0, free).into_iter().chain(floor.clone()).collect();
    let span = Span { lo: lo - below, hi };
    (Axis { name: shown.axis[body as usize].to_owned(), span, scale: Scale::Decades(lo), ticks }, floor)
}

/// The middle one of the sizes that are not zero: a peak does not move it, and neither does a dip.
fn usual(trace: &Trace) -> Option<f64> {
    let mut sizes: Vec<f64> = trace.iter().flatten().map(|point| point[1]).filter(|size| *size > 0.0).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied()
}

/// The names at the ends of the lines, moved apart where they would cover each other.
fn name_ends(figure: &mut Figure, mut ends: Vec<(usize, Point)>, names: &[String]) {
    let (edge, bottom) = (figure.frame.right(), figure.frame.bottom());
    ends.sort_by(|a, b| a.1[1].total_cmp(&b.1[1]));
    let mut heights: Vec<f64> = Vec::with_capacity(ends.len());
    for (_, [_, y]) in &ends {
        heights.push(heights.last().map_or(*y, |above| y.max(above + NAMES)));
    }
    let mut room = bottom - 4.0;
    for height in heights.iter_mut().rev() {
        *height = height.min(room);
        room = *height - NAMES;
    }
    for ((method, [x, y]), height) in ends.into_iter().zip(heights) {
        // A run that ends early, or left the picture, is tied to its name by the look alone.
        let inside = edge - x < 1.0 && figure.frame.holds([x, y]);
        let from = if inside { [edge + 2.0, y] } else { [edge + 5.0, height] };
        figure.canvas.line([from, [edge + 15.0, height]], Ink::Method(method), 1.0, 1.2);
        figure.canvas.text(&names[method], [edge + 18.0, height], Anchor::Left, SIZE);
    }
}
