//! The sleigh itself: its shape, and where it stands along a path.

use super::Series;
use super::axis;
use super::canvas::{Anchor, Canvas, Drawn, Ink, units};
use super::geometry::{PlotFrame, distance};

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
/// The blade.
const BLADE: [[f64; 2]; 2] = [[-6.0, 0.0], [6.0, 0.0]];
/// The rim of a rotor and its spokes.
const RIM: f64 = 4.6;

/// How many times the sleigh is drawn, where there is room for it.
const SLEIGHS: usize = 9;
/// How far apart sleighs have to be, so that each can be seen.
pub(super) const APART: f64 = 32.0;

/// The sleigh at equally spaced times, except where it would hide itself, and the start.
pub(super) fn sleighs(canvas: &Canvas<'_>, frame: &PlotFrame, series: &Series) -> Drawn {
    let nodes = series.path.len().min(series.heading.len());
    let mut drawn: Vec<[f64; 2]> = Vec::new();
    for node in moments(&series.time, nodes) {
        let heading = series.heading[node];
        let Some(place) = frame.place(series.path[node]).filter(|place| heading.is_finite() && frame.holds(*place))
        else {
            continue;
        };
        if drawn.iter().all(|other| distance(*other, place) > APART) {
            sleigh(canvas, place, heading)?;
            followers(canvas, frame, series, node, place)?;
            drawn.push(place);
        }
    }
    start(canvas, frame, series)
}

/// The blades behind it at a node, and the bars from each to the next.
fn followers(canvas: &Canvas<'_>, frame: &PlotFrame, series: &Series, node: usize, first: [f64; 2]) -> Drawn {
    let mut bars = vec![first];
    for follower in &series.followers {
        let Some([x, y, heading]) = follower.get(node).copied().filter(|place| place.iter().all(|x| x.is_finite()))
        else {
            break;
        };
        let Some(place) = frame.place([x, y]).filter(|place| frame.holds(*place)) else { break };
        let (sin, cos) = heading.sin_cos();
        canvas.line(&BLADE.map(|[ahead, _]| [place[0] + ahead * cos, place[1] - ahead * sin]), Ink::Text, 1.0, 2.2)?;
        bars.push(place);
    }
    if bars.len() > 1 { canvas.line(&bars, Ink::Text, 0.6, 1.0) } else { Ok(()) }
}

/// The blade alone, as SVG for what moves it.
pub(super) fn blade() -> String {
    let [[behind, _], [ahead, _]] = BLADE;
    format!(
        "<polyline stroke=\"currentColor\" stroke-width=\"{}\" points=\"{},0 {},0\"/>",
        units(2.2),
        units(behind),
        units(ahead)
    )
}

/// The word beside the start where it is farthest from the path: behind the sleigh, ahead of it, or to a side.
fn start(canvas: &Canvas<'_>, frame: &PlotFrame, series: &Series) -> Drawn {
    let Some(place) = series.path.first().and_then(|point| frame.place(*point)).filter(|place| frame.holds(*place))
    else {
        return Ok(());
    };
    let heading = series.heading.first().copied().filter(|heading| heading.is_finite()).unwrap_or(0.0);
    let path: Vec<[f64; 2]> = series.path.iter().filter_map(|point| frame.place(*point)).collect();
    let room = |[x, y]: [f64; 2]| {
        // Half the word reaches so far to the left and to the right.
        let ends = [-12.0, 0.0, 12.0].map(|along| [x + along, y]);
        let nearest = |end: [f64; 2]| path.iter().map(|point| distance(*point, end)).fold(f64::INFINITY, f64::min);
        ends.map(nearest).into_iter().fold(f64::INFINITY, f64::min)
    };
    let mut best: Option<([f64; 2], f64)> = None;
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
    best.map_or(Ok(()), |(at, _)| canvas.text("start", at, Anchor::Middle, axis::SIZE))
}

/// The nodes nearest to equally spaced times; equally spaced nodes where the times do not increase.
fn moments(time: &[f64], nodes: usize) -> Vec<usize> {
    let ordered = time.len() >= nodes && time.iter().take(nodes).is_sorted_by(|a, b| a <= b);
    let last = nodes.saturating_sub(1);
    let mut moments: Vec<usize> = (0..SLEIGHS)
        .map(|k| k as f64 / (SLEIGHS - 1) as f64)
        .map(|share| match (time.first(), time.get(last)) {
            (Some(start), Some(end)) if ordered => {
                time[..nodes].partition_point(|t| *t < start + share * (end - start)).min(last)
            }
            _ => (share * last as f64).round() as usize,
        })
        .filter(|_| nodes > 0)
        .collect();
    moments.dedup();
    moments
}

/// A sleigh: the body with its nose ahead, and the blade that touches the ground at the point.
fn sleigh(canvas: &Canvas<'_>, [x, y]: [f64; 2], heading: f64) -> Drawn {
    let (sin, cos) = heading.sin_cos();
    let place = |[ahead, left]: [f64; 2]| [x + ahead * cos - left * sin, y - ahead * sin - left * cos];
    let mut outline = BODY.map(place).to_vec();
    canvas.fill(&outline, Ink::Text, 0.13)?;
    outline.push(outline[0]);
    canvas.line(&outline, Ink::Text, 0.75, 1.1)?;
    canvas.line(&BLADE.map(place), Ink::Text, 1.0, 2.6)
}

/// The same shape at the origin, heading to the right, with a rotor if there is one, as SVG for what moves it.
pub(super) fn shape(rotor: bool) -> String {
    let corner = |[ahead, left]: [f64; 2]| format!("{},{}", units(ahead), units(-left));
    let corners = |points: &[[f64; 2]]| points.iter().map(|point| corner(*point)).collect::<Vec<_>>().join(" ");
    let mut shape = format!(
        "<polygon class=\"body\" stroke=\"currentColor\" stroke-width=\"{}\" points=\"{}\"/>\
         <polyline stroke=\"currentColor\" stroke-width=\"{}\" points=\"{}\"/>",
        units(1.1),
        corners(&BODY),
        units(2.6),
        corners(&BLADE),
    );
    if rotor {
        let rim = units(RIM);
        shape += &format!(
            "<g class=\"rotor\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"{}\"><circle r=\"{rim}\"/>\
             <path d=\"M{} 0H{rim}M0 {0}V0\"/></g>",
            units(1.0),
            -rim
        );
    }
    shape
}
