//! Errors against what they cost, on two logarithmic axes.

use super::canvas::{Anchor, Canvas, Shape, text_width};
use super::figure::{Axis, Figure, LegendEntry, SIZE};
use super::frame::{Frame, Scale, Span};
use super::look::{self, Ink};
use super::ticks::{decades, margin, whole_decades};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 420.0;
/// The orders that the guides show.
const ORDERS: [i32; 4] = [2, 4, 8, 16];

/// The runs of one method, from coarse to fine.
#[derive(Debug, Clone)]
pub struct CostCurve {
    /// The name of the method.
    pub label: String,
    /// The runs that have an error and a time.
    pub points: Vec<CostPoint>,
}

/// What a run cost, and what it brought. All numbers are positive.
#[derive(Debug, Clone)]
pub struct CostPoint {
    /// The error at the end (m or rad).
    pub error: f64,
    /// The time of the run (s).
    pub seconds: f64,
    /// The step (s), of a method with one.
    pub step: Option<f64>,
    /// The error is round-off.
    pub plateau: bool,
    /// No other point is better in both.
    pub pareto: bool,
    /// What a pointer is told.
    pub text: String,
}

/// Draws the errors against the time of a run, where they fall to the right, or against the step, where they fall to the left.
pub(crate) fn picture(costs: &[CostCurve], heading: &str, name: &str, time: bool) -> Figure {
    let (what, across, caption) = if time {
        let caption = "What accuracy costs: the error at the end against the time of a run. A point further down is more \
            exact, one further left is faster. The broad band joins the points that no other point beats in both; thin \
            dashes have the slopes of the orders; small dots are round-off. A pointer over a point shows its numbers.";
        ("time", "time of a run [s]", caption)
    } else {
        ("step", "step [s]", "The same errors against the step, where a slope is the order of the method.")
    };
    let shown = |point: &CostPoint| Some([if time { point.seconds } else { point.step? }, point.error]);
    let axis = |axis: usize, name: &str, most: f64| {
        let scale = Scale::Decades(f64::NEG_INFINITY);
        let points = costs.iter().flat_map(|curve| &curve.points).filter_map(shown);
        let span = Span::of(points.map(|point| scale.of(point[axis]))).unwrap_or(Span { lo: -1.0, hi: 0.0 });
        let span = whole_decades(span, 0.02);
        Axis { name: name.to_owned(), span, scale, ticks: decades(span, most, 0.0) }
    };
    let [x, y] = [axis(0, across, 9.0), axis(1, "error at the end [m or rad]", 12.0)];
    let curves = || costs.iter().enumerate();
    let drawn = curves().filter(|(_, curve)| curve.points.iter().any(|point| shown(point).is_some()));
    let legend: Vec<LegendEntry<'_>> = drawn.map(|(k, curve)| (Ink::Method(k), curve.label.as_str())).collect();
    let left = margin(&y.ticks);
    let mut figure = Figure::new(&legend, [WIDTH, HEIGHT], [left, 24.0], [x, y]);
    let frame = figure.frame;
    let place = |point: &CostPoint| frame.place(shown(point)?);
    guides(&mut figure.canvas, &frame, time);
    if time {
        // The front of the points that nothing beats, as a broad band behind the curves.
        let mut best: Vec<&CostPoint> = curves().flat_map(|(_, curve)| &curve.points).filter(|p| p.pareto).collect();
        best.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let line: Vec<[f64; 2]> = best.into_iter().filter_map(place).collect();
        if line.len() > 1 {
            figure.canvas.line(line, Ink::Text, 0.18, 7.0);
        }
    }
    let mut tips = Vec::new();
    for (method, curve) in curves() {
        let points: Vec<_> = curve.points.iter().filter_map(|point| Some((place(point)?, point))).collect();
        let places: Vec<_> = points.iter().map(|(place, _)| Some(*place)).collect();
        figure.line(&places, None, (Ink::Method(method), 0.9, look::width(1)));
        for (at, point) in points {
            match point.plateau {
                true => figure.canvas.fill(&look::regular(12, 2.0, 0.0), at, Ink::Method(method), 0.6),
                false => figure.canvas.marker(method, at),
            }
            tips.push(Shape::Tip { text: point.text.clone(), at });
        }
    }
    tips.into_iter().for_each(|tip| figure.canvas.draw(tip, Ink::Text, 1.0));
    let title = format!("{heading}: error against {what}");
    figure.named(format!("{name}-{what}"), title, caption.to_owned())
}

/// The slopes of the orders, from the upper corner where the steps are coarse.
fn guides(canvas: &mut Canvas, frame: &Frame, time: bool) {
    let (from, fine) = if time { (frame.x.lo, frame.x.hi) } else { (frame.x.hi, frame.x.lo) };
    for order in ORDERS {
        let slope = f64::from(order);
        let run = f64::min((frame.y.hi - frame.y.lo) / slope, (fine - from).abs());
        let end = [from + run * (fine - from).signum(), frame.y.hi - slope * run];
        let (Some(begin), Some(end)) = (frame.at([from, frame.y.hi]), frame.at(end)) else { continue };
        canvas.line([begin, end], Ink::Exact, 0.45, 1.0);
        let text = format!("order {order}");
        let near = [0, 1].map(|axis| begin[axis] + 0.9 * (end[axis] - begin[axis]));
        let inside = near[0] + 6.0 + text_width(&text, SIZE) < frame.right();
        let (shift, anchor) = if inside { (5.0, Anchor::Left) } else { (-5.0, Anchor::Right) };
        canvas.text(&text, [near[0] + shift, near[1]], anchor, 0.85 * SIZE);
    }
}
