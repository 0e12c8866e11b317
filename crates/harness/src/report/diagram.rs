//! Errors against what they cost, on two logarithmic axes.

use super::ReportError;
use super::axis::{self, SIZE};
use super::canvas::{Anchor, Canvas, Drawn, Ink, text_width};
use super::geometry::{PlotFrame, Span};
use super::look;
use super::picture::Picture;
use crate::precision::{Curve, Mark, PrecisionPoint, RungSetting};
use lagrangian::Shown;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 420.0;
/// The orders that the guides show.
const ORDERS: [i32; 4] = [2, 4, 8, 16];

/// What a diagram shows of a point.
#[derive(Debug, Clone, Copy)]
pub(super) enum Abscissa {
    /// The time of the run: errors fall to the right.
    Seconds,
    /// The step: they fall to the left.
    Step,
}

impl Abscissa {
    fn of(self, point: &PrecisionPoint) -> Option<[f64; 2]> {
        let [error, seconds] = point.measured()?;
        match (self, point.setting) {
            (Self::Seconds, _) => Some([seconds, error]),
            (Self::Step, Some(RungSetting::Step(step))) if step > 0.0 => Some([step, error]),
            (Self::Step, _) => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Seconds => "time of a run [s]",
            Self::Step => "step [s]",
        }
    }
}

/// Draws the diagram of some curves.
pub(super) fn picture(
    curves: &[Curve],
    abscissa: Abscissa,
    [file, title, caption]: [String; 3],
) -> Result<Picture, ReportError> {
    let placed = |point: &PrecisionPoint| abscissa.of(point).map(|[x, y]| [x.log10(), y.log10()]);
    let all: Vec<[f64; 2]> = curves.iter().flat_map(|curve| &curve.points).filter_map(placed).collect();
    let [x, y] = [0, 1].map(|axis| decades(all.iter().map(|point| point[axis])));
    let labels: Vec<String> = curves.iter().map(Curve::label).collect();
    let shown = |curve: &Curve| curve.points.iter().any(|point| placed(point).is_some());
    let entries: Vec<axis::LegendEntry<'_>> = curves
        .iter()
        .zip(&labels)
        .enumerate()
        .filter(|(_, (curve, _))| shown(curve))
        .map(|(method, (_, label))| (Ink::Method(method), label.as_str()))
        .collect();
    let (places, legend) = axis::legend(&entries, WIDTH - 20.0);
    let (across, up) = (axis::decades(x, 9.0), axis::decades(y, 12.0));
    let left = axis::margin(&up);
    let frame = PlotFrame { left, top: legend + 34.0, width: WIDTH - left - 24.0, height: HEIGHT, x, y };
    let mut tips = Vec::new();
    for curve in curves {
        let seen = |point: &PrecisionPoint| Some((frame.place(placed(point)?)?, told(&curve.label(), point)));
        tips.extend(curve.points.iter().filter_map(seen));
    }
    let picture = Picture::draw(file, title, caption, [WIDTH, frame.bottom() + 44.0], |canvas| {
        axis::draw_legend(canvas, &entries, &places, [10.0, 4.0])?;
        axis::draw(canvas, &frame, [&across, &up], [abscissa.name(), "error at the end [m or rad]"])?;
        guides(canvas, &frame, abscissa)?;
        front(canvas, &frame, curves, abscissa)?;
        for (method, curve) in curves.iter().enumerate() {
            let points: Vec<_> = curve.points.iter().map(|point| frame.place(placed(point)?)).collect();
            // A run that failed is no gap between its neighbours: the line goes on.
            for line in frame.lines(points.iter().copied().filter(Option::is_some)) {
                canvas.line(&line, Ink::Method(method), 0.9, look::width(1))?;
            }
            for (place, point) in points.iter().zip(&curve.points) {
                let Some(place) = place else { continue };
                if point.mark == Some(Mark::Plateau) {
                    let dot = look::regular(12, 2.0, 0.0);
                    let dot: Vec<_> = dot.iter().map(|[dx, dy]| [place[0] + dx, place[1] + dy]).collect();
                    canvas.fill(&dot, Ink::Method(method), 0.6)?;
                } else {
                    canvas.marker(method, *place)?;
                }
            }
        }
        Ok(())
    })?;
    Ok(picture.told(&tips))
}

/// What a pointer is told over a point: the numbers of the table, with the same digits.
fn told(label: &str, point: &PrecisionPoint) -> String {
    let mut text = label.to_owned();
    if let Some(setting) = point.setting {
        text += &format!(", {setting}");
    }
    for (name, value, unit) in
        [("error", point.error, ""), ("wall", point.wall_seconds, " s"), ("CPU", point.cpu_seconds, " s")]
    {
        text += &value.map_or_else(String::new, |value| format!(", {name} {}{unit}", Shown(value)));
    }
    text + &point.mark.as_ref().map_or_else(String::new, |mark| format!(", {mark}"))
}

/// Whole decades that hold all values.
fn decades(values: impl Iterator<Item = f64>) -> Span {
    let Span { lo, hi } = Span::of(values).unwrap_or(Span { lo: -1.0, hi: 0.0 });
    let lo = (lo - 0.02).floor();
    Span { lo, hi: (hi + 0.02).ceil().max(lo + 1.0) }
}

/// The slopes of the orders, from the upper corner where the steps are coarse.
fn guides(canvas: &Canvas<'_>, frame: &PlotFrame, abscissa: Abscissa) -> Drawn {
    let (from, fine) = match abscissa {
        Abscissa::Seconds => (frame.x.lo, frame.x.hi),
        Abscissa::Step => (frame.x.hi, frame.x.lo),
    };
    for order in ORDERS {
        let slope = f64::from(order);
        let run = f64::min((frame.y.hi - frame.y.lo) / slope, (fine - from).abs());
        let end = [from + run * (fine - from).signum(), frame.y.hi - slope * run];
        let (Some(begin), Some(end)) = (frame.place([from, frame.y.hi]), frame.place(end)) else { continue };
        canvas.line(&[begin, end], Ink::Exact, 0.45, 1.0)?;
        let text = format!("order {order}");
        let near = [0, 1].map(|axis| begin[axis] + 0.9 * (end[axis] - begin[axis]));
        let inside = near[0] + 6.0 + text_width(&text, SIZE) < frame.right();
        let (shift, anchor) = if inside { (5.0, Anchor::Left) } else { (-5.0, Anchor::Right) };
        canvas.text(&text, [near[0] + shift, near[1]], anchor, 0.85 * SIZE)?;
    }
    Ok(())
}

/// The front of the points that nothing beats, as a broad band behind the curves.
fn front(canvas: &Canvas<'_>, frame: &PlotFrame, curves: &[Curve], abscissa: Abscissa) -> Drawn {
    if matches!(abscissa, Abscissa::Step) {
        return Ok(());
    }
    let best = curves.iter().flat_map(|curve| &curve.points).filter(|point| point.pareto);
    let mut best: Vec<[f64; 2]> = best.filter_map(|point| abscissa.of(point)).collect();
    best.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let line: Vec<[f64; 2]> = best.iter().filter_map(|[x, y]| frame.place([x.log10(), y.log10()])).collect();
    if line.len() < 2 { Ok(()) } else { canvas.line(&line, Ink::Text, 0.18, 7.0) }
}
