//! The scene in motion: what `page.js` moves, and where it moves it.

use super::canvas::{Ink, units};
use super::geometry::PlotFrame;
use super::look;
use super::path::view;
use super::picture::Picture;
use super::sleigh;
use super::xml::escape;
use super::{ReportError, SceneReport, Series, leading};
use std::fmt::Write;

/// Room above the frame, for the name of the upright axis.
const TOP: f64 = 34.0;
/// Room below it, for the figures.
const BELOW: f64 = 44.0;
/// How far a node may lie from the straight line between its neighbours in time and be left out: in units of the picture,
/// as an angle of the sleigh, and as one of the rotor (degrees).
const NEAR: [f64; 4] = [0.25, 0.25, 0.5, 4.0];
/// How many nodes may be left out in a row.
const GAP: usize = 40;
/// Digits of the time, relative to the whole.
const TICKS: f64 = 2e5;

/// A node as the picture has it: the time (s), the place (units of the picture), heading and rotor (degrees).
struct DrawnNode {
    t: f64,
    at: [f64; 4],
    /// Of each blade behind it, its place and its heading.
    followers: Vec<[f64; 3]>,
}

/// The figure; none where no run has two nodes to move between.
pub(super) fn figure(scene: &SceneReport) -> Result<Option<String>, ReportError> {
    let Some((method, series)) = leading(scene) else { return Ok(None) };
    let view = view(scene, TOP);
    let nodes = thinned(nodes(series, &view.frame));
    let [Some(first), Some(last)] = [nodes.first(), nodes.last()] else { return Ok(None) };
    if last.t <= first.t {
        return Ok(None);
    }
    let frame = &view.frame;
    let size = [frame.left + frame.width + super::path::RIGHT, frame.bottom() + BELOW];
    let title = format!("{}: the sleigh in motion", scene.title);
    let ground = Picture::draw(String::new(), title, String::new(), size, |canvas| {
        view.axes(canvas)?;
        view.line(canvas, &series.path, Ink::Text, 0.3, 1.2)
    })?;
    let rotor = !series.rotor.is_empty();
    let mut figure = format!(
        "<figure class=\"animation\" data-frame=\"0\">\n{}\n",
        ground.with_inside(&stage(method, frame, first, rotor))
    );
    let step = (last.t - first.t) / 500.0;
    let _ = writeln!(
        figure,
        "<div class=\"controls\" hidden><button type=\"button\">Play</button><input type=\"range\" aria-label=\"Time\" \
         min=\"{}\" max=\"{}\" step=\"{step}\" value=\"{0}\"><output></output><label>Speed <select></select></label></div>",
        first.t, last.t
    );
    figure += "<script type=\"application/json\">{";
    let tick = (last.t - first.t) / TICKS;
    let decimals = (-tick.log10().floor()).clamp(0.0, 17.0) as usize;
    list(&mut figure, "t", nodes.iter().map(|node| node.t), decimals);
    for (axis, name) in ["x", "y", "heading", "rotor"].into_iter().enumerate().filter(|(axis, _)| *axis < 3 || rotor) {
        figure.push(',');
        let scale = if axis < 2 { f64::from(units(1.0)) } else { 1.0 };
        list(&mut figure, name, nodes.iter().map(|node| scale * node.at[axis]), usize::from(axis >= 2));
    }
    if !first.followers.is_empty() {
        figure += ",\"followers\":[";
        for k in 0..first.followers.len() {
            figure += if k == 0 { "{" } else { ",{" };
            for (axis, name) in ["x", "y", "heading"].into_iter().enumerate() {
                figure += if axis == 0 { "" } else { "," };
                let scale = if axis < 2 { f64::from(units(1.0)) } else { 1.0 };
                let decimals = usize::from(axis >= 2);
                list(&mut figure, name, nodes.iter().map(|node| scale * node.followers[k][axis]), decimals);
            }
            figure.push('}');
        }
        figure.push(']');
    }
    figure += "}</script>\n";
    let turning = if rotor { " The wheel on the sleigh is the rotor, and turns with the rotor." } else { "" };
    let _ = writeln!(
        figure,
        "<figcaption>The motion of the sleigh by {}, with the path so far, and in grey the whole \
            path.{turning}</figcaption>\n</figure>",
        escape(&series.label)
    );
    Ok(Some(figure))
}

/// What moves, at the first node, cut off at the frame.
fn stage(method: usize, frame: &PlotFrame, first: &DrawnNode, rotor: bool) -> String {
    let [left, top, width, height] = [frame.left, frame.top, frame.width, frame.height].map(units);
    let [x, y, heading, _] = first.at;
    let [x, y] = [x, y].map(units);
    format!(
        "<svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" viewBox=\"{left} {top} {width} {height}\">\
         <polyline class=\"trail\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" points=\"{x},{y}\"/>\
         {}<g class=\"sleigh\" transform=\"translate({x},{y}) rotate({:.2})\">{}</g></svg>",
        look::colour(method),
        units(2.2),
        behind(first),
        -heading,
        sleigh::shape(rotor),
    )
}

/// The blades behind the sleigh and their bars, at the first node.
fn behind(first: &DrawnNode) -> String {
    if first.followers.is_empty() {
        return String::new();
    }
    let at = |[x, y, _]: &[f64; 3]| format!("{},{}", units(*x), units(*y));
    let blades: String = first
        .followers
        .iter()
        .map(|place| {
            let blade = sleigh::blade();
            format!("<g class=\"follower\" transform=\"translate({}) rotate({:.2})\">{blade}</g>", at(place), -place[2])
        })
        .collect();
    let [x, y, heading, _] = first.at;
    let places: Vec<String> = std::iter::once(at(&[x, y, heading])).chain(first.followers.iter().map(at)).collect();
    format!(
        "<polyline class=\"bars\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"{}\" points=\"{}\"/>{blades}",
        units(1.0),
        places.join(" ")
    )
}

/// The nodes that can be drawn, in order of time.
fn nodes(series: &Series, frame: &PlotFrame) -> Vec<DrawnNode> {
    let count = series.path.len().min(series.heading.len()).min(series.time.len());
    let mut nodes: Vec<DrawnNode> = Vec::with_capacity(count);
    for k in 0..count {
        let rotor = series.rotor.get(k).copied().unwrap_or(0.0);
        let (t, heading) = (series.time[k], series.heading[k]);
        let finite = t.is_finite() && heading.is_finite() && rotor.is_finite();
        // Places far outside the frame are as good as at its edge, and shorter to write.
        let place = frame.place(series.path[k]).map(|place| place.map(|length| length.clamp(-1e4, 1e4)));
        if let Some([x, y]) = place.filter(|_| finite && nodes.last().is_none_or(|before| before.t < t)) {
            // A place that cannot be drawn is where the blade before it is.
            let mut last = [x, y, heading.to_degrees()];
            let followers = series.followers.iter().map(|follower| {
                if let Some([x, y, heading]) =
                    follower.get(k).copied().filter(|place| place.iter().all(|x| x.is_finite()))
                    && let Some(place) = frame.place([x, y])
                {
                    let [x, y] = place.map(|length| length.clamp(-1e4, 1e4));
                    last = [x, y, heading.to_degrees()];
                }
                last
            });
            let followers = followers.collect();
            nodes.push(DrawnNode { t, at: [x, y, heading.to_degrees(), rotor.to_degrees()], followers });
        }
    }
    nodes
}

/// Leaves out nodes that a straight line between their neighbours stands for.
fn thinned(nodes: Vec<DrawnNode>) -> Vec<DrawnNode> {
    let straight = |from: usize, to: usize| {
        nodes[from + 1..to].iter().all(|node| {
            let [a, b] = [&nodes[from], &nodes[to]];
            let share = (node.t - a.t) / (b.t - a.t);
            let near = |a: &[f64], b: &[f64], at: &[f64]| {
                (0..at.len()).all(|i| (a[i] + share * (b[i] - a[i]) - at[i]).abs() <= NEAR[i])
            };
            let behind = a.followers.iter().zip(&b.followers).zip(&node.followers);
            near(&a.at, &b.at, &node.at) && behind.into_iter().all(|((a, b), at)| near(a, b, at))
        })
    };
    let mut from = 0;
    let kept: Vec<bool> = (0..nodes.len())
        .map(|k| {
            let keep = k == 0 || k + 1 == nodes.len() || k - from >= GAP || !straight(from, k + 1);
            if keep {
                from = k;
            }
            keep
        })
        .collect();
    nodes.into_iter().zip(kept).filter_map(|(node, keep)| keep.then_some(node)).collect()
}

/// A named list of numbers.
fn list(text: &mut String, name: &str, values: impl Iterator<Item = f64>, decimals: usize) {
    let numbers: Vec<String> = values.map(|value| format!("{value:.decimals$}")).collect();
    let _ = write!(text, "\"{name}\":[{}]", numbers.join(","));
}
