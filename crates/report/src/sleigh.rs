//! The sleigh itself: its shape, and where it stands along a path.

use super::canvas::{Anchor, Canvas, Point};
use super::figure::SIZE;
use super::frame::{Frame, distance};
use super::look::Ink;
use super::svg::units;
use super::{Body, Series};

/// The body with its nose ahead, about the blade's contact point; ahead, then to the left.
const BODY: [[f64; 2]; 9] = [
    [19.0, 0.0],
    [14.0, 4.2],
    [6.0, 7.0],
    [-7.0, 7.0],
    [-9.0, 5.0],
    [-9.0, -5.0],
    [-7.0, -7.0],
    [6.0, -7.0],
    [14.0, -4.2],
];
/// An arrow, for any other system.
const ARROW: [[f64; 2]; 4] = [[13.0, 0.0], [-9.0, 6.5], [-5.0, 0.0], [-9.0, -6.5]];
/// The blade.
const BLADE: [[f64; 2]; 2] = [[-6.0, 0.0], [6.0, 0.0]];
/// The rim of a rotor and its spokes.
const RIM: f64 = 4.6;
/// How wide the lines are of the body, of its blade, and of a blade behind it.
const WIDTHS: [f64; 3] = [1.1, 2.6, 2.2];

/// Number of times that the sleigh is drawn, if there is room.
const SLEIGHS: usize = 9;
/// Least distance between two drawn sleighs, so that each can be seen.
pub(crate) const APART: f64 = 32.0;

/// The place of a point on the ground in the picture, if it lies in the frame.
fn seen(frame: &Frame, [x, y, heading]: [f64; 3]) -> Option<Point> {
    frame.place([x, y]).filter(|place| heading.is_finite() && frame.holds(*place))
}

/// A shape on the ground, at a point along a heading.
fn turned<const K: usize>(shape: [[f64; 2]; K], [x, y]: Point, heading: f64) -> [Point; K] {
    let (sin, cos) = heading.sin_cos();
    shape.map(|[ahead, left]| [x + ahead * cos - left * sin, y - ahead * sin - left * cos])
}

/// Draws the sleigh at equally spaced times, except those at which it would cover itself, and marks the start.
pub(crate) fn sleighs(canvas: &mut Canvas, frame: &Frame, body: Body, series: &Series) {
    let nodes = series.path.len().min(series.heading.len());
    let mut drawn: Vec<Point> = Vec::new();
    for node in moments(&series.time, nodes) {
        let ([x, y], heading) = (series.path[node], series.heading[node]);
        let place = seen(frame, [x, y, heading]);
        let Some(place) = place.filter(|place| drawn.iter().all(|other| distance(*other, *place) > APART)) else {
            continue;
        };
        let mut outline = match body {
            Body::Sleigh => turned(BODY, place, heading).to_vec(),
            Body::Other => turned(ARROW, place, heading).to_vec(),
        };
        canvas.fill(&outline, [0.0; 2], Ink::Text, 0.13);
        outline.push(outline[0]);
        canvas.line(outline, Ink::Text, 0.75, WIDTHS[0]);
        if body == Body::Sleigh {
            canvas.line(turned(BLADE, place, heading), Ink::Text, 1.0, WIDTHS[1]);
        }
        drawn.push(place);
        // The blades behind it, and the bars from each to the next.
        let mut bars = vec![place];
        let behind = series.followers.iter().map_while(|follower| {
            let follower = follower.get(node)?;
            Some((seen(frame, *follower)?, follower[2]))
        });
        for (place, heading) in behind {
            canvas.line(turned(BLADE, place, heading), Ink::Text, 1.0, WIDTHS[2]);
            bars.push(place);
        }
        if bars.len() > 1 {
            canvas.line(bars, Ink::Text, 0.6, 1.0);
        }
    }
    start(canvas, frame, series);
}

/// Writes "start" beside the start at the place farthest from the path: behind the sleigh, ahead of it, or to a side.
fn start(canvas: &mut Canvas, frame: &Frame, series: &Series) {
    let Some(place) = series.path.first().and_then(|[x, y]| seen(frame, [*x, *y, 0.0])) else { return };
    let heading = series.heading.first().copied().filter(|heading| heading.is_finite()).unwrap_or(0.0);
    let path: Vec<Point> = series.path.iter().filter_map(|point| frame.place(*point)).collect();
    let room = |[x, y]: Point| {
        // Half the word reaches so far to the left and to the right.
        let ends = [-12.0, 0.0, 12.0].map(|along| [x + along, y]);
        let all = ends.iter().flat_map(|end| path.iter().map(|point| distance(*point, *end)));
        all.fold(f64::INFINITY, f64::min)
    };
    let mut best: Option<(Point, f64)> = None;
    for (turn, away) in [(0.5, [30.0, 24.0]), (0.0, [40.0, 34.0]), (0.25, [30.0, 20.0]), (0.75, [30.0, 20.0])] {
        let (sin, cos) = (heading + std::f64::consts::TAU * turn).sin_cos();
        let at = [place[0] + away[0] * cos, place[1] - away[1] * sin];
        let inside = (frame.left + 18.0..=frame.right() - 18.0).contains(&at[0])
            && (frame.top + 8.0..=frame.bottom() - 8.0).contains(&at[1]);
        let free = room(at);
        // As good as behind is not better.
        if inside && best.is_none_or(|(_, most)| free > most + 6.0) {
            best = Some((at, free));
        }
    }
    if let Some((at, _)) = best {
        canvas.text("start", at, Anchor::Middle, SIZE);
    }
}

/// The nodes nearest to equally spaced times, or equally spaced nodes if the times do not increase.
fn moments(time: &[f64], nodes: usize) -> Vec<usize> {
    let ordered = time.len() >= nodes && time.iter().take(nodes).is_sorted_by(|a, b| a <= b);
    let Some(last) = nodes.checked_sub(1) else { return Vec::new() };
    let node = |k: usize| {
        let share = k as f64 / (SLEIGHS - 1) as f64;
        match (time.first(), time.get(last)) {
            (Some(start), Some(end)) if ordered => {
                time[..nodes].partition_point(|t| *t < start + share * (end - start)).min(last)
            }
            _ => (share * last as f64).round() as usize,
        }
    };
    let mut moments: Vec<usize> = (0..SLEIGHS).map(node).collect();
    moments.dedup();
    moments
}

/// Corners of a shape at the origin, heading to the right, as SVG.
fn corners(shape: &[[f64; 2]]) -> String {
    let corner = |[ahead, left]: &[f64; 2]| format!("{},{}", units(*ahead), units(-left));
    shape.iter().map(corner).collect::<Vec<_>>().join(" ")
}

/// A blade at the origin, for what moves it.
fn blade(width: f64) -> String {
    let (width, corners) = (units(width), corners(&BLADE));
    format!("<polyline stroke=\"currentColor\" stroke-width=\"{width}\" points=\"{corners}\"/>")
}

/// A blade behind the sleigh, for what moves it.
pub(crate) fn follower() -> String {
    blade(WIDTHS[2])
}

/// The body at the origin, with a rotor if there is one, for what moves it.
pub(crate) fn shape(body: Body, rotor: bool) -> String {
    let width = units(WIDTHS[0]);
    let (corners, blade) = match body {
        Body::Sleigh => (corners(&BODY), blade(WIDTHS[1])),
        Body::Other => (corners(&ARROW), String::new()),
    };
    let (rim, thin) = (units(RIM), units(1.0));
    let body = format!(
        "<polygon class=\"body\" stroke=\"currentColor\" stroke-width=\"{width}\" points=\"{corners}\"/>{blade}"
    );
    let rotor = if rotor {
        format!(
            "<g class=\"rotor\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"{thin}\"><circle r=\"{rim}\"/>\
             <path d=\"M-{rim} 0H{rim}M0 -{rim}V{rim}\"/></g>"
        )
    } else {
        String::new()
    };
    body + &rotor
}
