//! The pictures of what should stay zero, against time, on a logarithmic axis.

use super::axis;
use super::canvas::{Anchor, Canvas, Drawn, Ink, text_width};
use super::geometry::{PlotFrame, Span, visible};
use super::look;
use super::picture::Picture;
use super::scale::{Scale, Trace};
use super::thinning::peaks;
use super::xml::label;
use super::{ReportError, SceneReport, Series, entries, failures, scaling};

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

/// Draws the picture of the constraint's residual.
pub(super) fn constraint(scene: &SceneReport, name: &str) -> Result<Picture, ReportError> {
    let caption =
        "How fast the blade slips sideways. Around 10⁻¹⁶ there is nothing but rounding: the constraint is kept.";
    draw(
        scene,
        format!("{name}-constraint"),
        "constraint residual",
        "|A(q) v + b|  [m/s]",
        caption,
        ROUNDING,
        |series| &series.constraint,
    )
}

/// Draws the picture of the energy error.
pub(super) fn energy(scene: &SceneReport, name: &str) -> Result<Picture, ReportError> {
    let caption = "The energy error: the energy less its initial value, and less the work W of whatever drives or \
        brakes the sleigh. A line that keeps climbing is drift.";
    draw(
        scene,
        format!("{name}-energy"),
        "energy error",
        "|E − E₀ − W|  [J]",
        caption,
        f64::NEG_INFINITY,
        |series| &series.energy_error,
    )
}

fn draw(
    scene: &SceneReport,
    file: String,
    what: &str,
    upright: &str,
    caption: &str,
    least: f64,
    values: impl Fn(&Series) -> &Vec<f64>,
) -> Result<Picture, ReportError> {
    let most = (TOGETHER / scene.series.len().max(1)).clamp(FEWEST, POINTS);
    let traces: Vec<Trace> = scene.series.iter().map(|series| peaks(&series.time, values(series), most)).collect();
    let longest = scene.series.iter().map(|series| series.time.len().min(values(series).len())).max().unwrap_or(0);
    let scaling: Vec<Trace> = scaling(scene).map(|series| peaks(&series.time, values(series), most)).collect();
    let scale = Scale::of(&scaling, least);
    let mut caption = captioned(caption, &scale, longest > most);
    let strays = scene.series.iter().zip(&traces).filter(|(_, trace)| scale.leaves(trace));
    let strays: Vec<&str> = strays.map(|(series, _)| series.label.as_str()).collect();
    if !strays.is_empty() {
        caption += &format!(" Curves that leave the picture: {}.", strays.join(", "));
    }
    caption += &failures(scene);
    let entries = entries(scene);
    let (places, legend) = axis::legend(&entries, WIDTH - 20.0);
    let up = scale.ticks();
    let names: Vec<String> = scene.series.iter().map(|series| label(&series.label, LONGEST)).collect();
    // More names than fit beside the frame are left to the legend.
    let named = entries.len() as f64 * NAMES <= HEIGHT;
    let right = names.iter().filter(|_| named).map(|name| text_width(name, axis::SIZE)).fold(0.0, f64::max) + 26.0;
    let left = axis::margin(&up);
    let frame = PlotFrame {
        left,
        top: legend + 34.0,
        width: WIDTH - left - right,
        height: HEIGHT,
        x: times(scene),
        y: scale.span(),
    };
    let across = axis::linear(frame.x, 6.0);
    let across = axis::linear(frame.x, (frame.width / (1.4 * axis::margin(&across))).clamp(2.0, 8.0));
    let size = [WIDTH, frame.bottom() + 44.0];
    Picture::draw(file, format!("{}: {what} against time", scene.title), caption, size, |canvas| {
        axis::draw_legend(canvas, &entries, &places, [10.0, 4.0])?;
        axis::draw(canvas, &frame, [&across, &up], ["t [s]", upright])?;
        if let Some((floor, _)) = &scale.floor
            && let Some([_, y]) = frame.place([frame.x.lo, *floor])
        {
            canvas.line(&[[frame.left, y], [frame.right(), y]], Ink::Exact, 0.6, 1.0)?;
        }
        let placed: Vec<Vec<Option<[f64; 2]>>> =
            traces.iter().map(|trace| trace.iter().map(|point| scale.place(&frame, *point)).collect()).collect();
        for (method, points) in placed.iter().enumerate() {
            for line in frame.lines(points.iter().copied()) {
                canvas.line(&line, Ink::Method(method), 1.0, look::width(method))?;
            }
        }
        markers(canvas, &frame, &placed)?;
        crosses(canvas, &frame, scene, &placed)?;
        if named { ends(canvas, &frame, &placed, &names) } else { Ok(()) }
    })
}

fn captioned(caption: &str, scale: &Scale, thinned: bool) -> String {
    let mut caption = caption.to_owned();
    if thinned {
        caption += " Each point is the largest value of a short stretch of time.";
    }
    if let Some((_, text)) = &scale.floor {
        caption += &format!(" Values {} and exact zeros lie on the dashed line.", text.replace("≤ ", "below "));
    }
    caption
}

/// From the first time to the last, also where nothing can be drawn, so that the pictures of a scene match.
fn times(scene: &SceneReport) -> Span {
    let Some(span) = Span::of(scene.series.iter().flat_map(|series| series.time.iter().copied())) else {
        return Span { lo: 0.0, hi: 1.0 };
    };
    let half = visible(span.half(), span.lo.abs().max(span.hi.abs()));
    if span.half() < half { Span { lo: span.lo, hi: span.lo + half } } else { span }
}

/// A few markers on each line, at other times for each method.
fn markers(canvas: &Canvas<'_>, frame: &PlotFrame, placed: &[Vec<Option<[f64; 2]>>]) -> Drawn {
    for (method, points) in placed.iter().enumerate() {
        let last = points.len().saturating_sub(1) as f64;
        for k in 0..6_u32 {
            let share = (f64::from(k) + (method as f64 + 0.5) / placed.len() as f64) / 6.0;
            if let Some(Some(place)) = points.get((share * last).round() as usize)
                && frame.holds(*place)
            {
                canvas.marker(method, *place)?;
            }
        }
    }
    Ok(())
}

/// A cross where the line of a run that failed stops; at the edge where the line has left the picture upwards.
fn crosses(canvas: &Canvas<'_>, frame: &PlotFrame, scene: &SceneReport, placed: &[Vec<Option<[f64; 2]>>]) -> Drawn {
    for (method, points) in placed.iter().enumerate().filter(|(method, _)| scene.series[*method].failed) {
        if let Some([x, y]) = points.iter().rev().flatten().next() {
            canvas.cross(method, [*x, y.clamp(frame.top, frame.bottom())])?;
        }
    }
    Ok(())
}

/// The names at the ends of the lines, moved apart where they would cover each other.
fn ends(canvas: &Canvas<'_>, frame: &PlotFrame, placed: &[Vec<Option<[f64; 2]>>], names: &[String]) -> Drawn {
    let inside = |[x, y]: [f64; 2]| [x, y.clamp(frame.top, frame.bottom())];
    let last = |points: &Vec<Option<[f64; 2]>>| points.iter().rev().flatten().next().copied().map(inside);
    let mut ends: Vec<(usize, [f64; 2])> =
        placed.iter().enumerate().filter_map(|(method, points)| Some((method, last(points)?))).collect();
    ends.sort_by(|a, b| a.1[1].total_cmp(&b.1[1]));
    let mut heights: Vec<f64> = Vec::with_capacity(ends.len());
    for (_, [_, y]) in &ends {
        heights.push(heights.last().map_or(*y, |above| y.max(above + NAMES)));
    }
    let mut room = frame.bottom() - 4.0;
    for height in heights.iter_mut().rev() {
        *height = height.min(room);
        room = *height - NAMES;
    }
    for ((method, [x, y]), height) in ends.iter().zip(&heights) {
        let edge = frame.right();
        // A run that ends early, or left the picture, is tied to its name by the look alone.
        let from = if edge - x < 1.0 && frame.holds([*x, *y]) { [edge + 2.0, *y] } else { [edge + 5.0, *height] };
        canvas.line(&[from, [edge + 15.0, *height]], Ink::Method(*method), 1.0, 1.2)?;
        canvas.text(&names[*method], [edge + 18.0, *height], Anchor::Left, axis::SIZE)?;
    }
    Ok(())
}
