//! The sleigh itself, drawn along a path.

use super::Series;
use super::axis;
use super::canvas::{Anchor, Canvas, Drawn, Ink};
use super::geometry::{Frame, distance};

/// How many times the sleigh is drawn, where there is room for it.
const SLEIGHS: usize = 9;
/// How far apart sleighs have to be, so that each can be seen.
pub(super) const APART: f64 = 32.0;

/// The sleigh at equally spaced times, except where it would hide itself, and the start.
pub(super) fn sleighs(canvas: &Canvas<'_>, frame: &Frame, series: &Series) -> Drawn {
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
            drawn.push(place);
        }
    }
    let Some(place) = series.path.first().and_then(|point| frame.place(*point)).filter(|place| frame.holds(*place))
    else {
        return Ok(());
    };
    // Behind the sleigh, where the path cannot be yet.
    let heading = series.heading.first().copied().filter(|heading| heading.is_finite()).unwrap_or(0.0);
    let behind = [place[0] - 30.0 * heading.cos(), place[1] + 24.0 * heading.sin()];
    let inside = [
        behind[0].clamp(frame.left + 18.0, frame.right() - 18.0),
        behind[1].clamp(frame.top + 8.0, frame.bottom() - 8.0),
    ];
    // Where the frame pushes the word back onto the sleigh, it goes above or below.
    let above = if place[1] - 24.0 > frame.top { place[1] - 20.0 } else { place[1] + 20.0 };
    let at = if distance(inside, behind) > 4.0 { [inside[0], above] } else { inside };
    canvas.text("start", at, Anchor::Middle, axis::SIZE)
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
    let body = [
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
    let mut outline = body.map(place).to_vec();
    canvas.fill(&outline, Ink::Text, 0.13)?;
    outline.push(outline[0]);
    canvas.line(&outline, Ink::Text, 0.75, 1.1)?;
    canvas.line(&[[-6.0, 0.0], [6.0, 0.0]].map(place), Ink::Text, 1.0, 2.6)
}
