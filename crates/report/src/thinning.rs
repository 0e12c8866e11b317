//! Fewer points, the same picture.

use super::canvas::Point;
use super::frame::{distance, drawable};
use std::collections::HashSet;

/// Lines as a picture draws them.
type Polylines = Vec<Vec<Point>>;

/// The time and the size of each peak, in order; nothing where the values are not finite.
pub(crate) type Trace = Vec<Option<[f64; 2]>>;

/// Largest distance of a line from a point that is left out: less than anti-aliasing shows.
const BESIDE: f64 = 0.15;

/// Leaves out points closer to their predecessor than the eye can tell, or on the straight line between others. If more than `most`
/// points remain before the second rule, also leaves out lines that repeat themselves, as a circle run through a thousand times, and then
/// points a little further apart.
pub(crate) fn thin(lines: Polylines, most: usize) -> Polylines {
    let mut lines = few(lines, most);
    lines.iter_mut().for_each(straighten);
    lines
}

fn few(lines: Polylines, most: usize) -> Polylines {
    let few = |lines: &Polylines| lines.iter().map(Vec::len).sum::<usize>() <= most;
    let fine = sparser(lines, 0.7);
    if few(&fine) {
        return fine;
    }
    let mut thinned = first_visits(sparser(fine, 1.0));
    // Beyond the last of these distances the shape would suffer more than the size of the file.
    for tolerance in [2.0, 3.0, 4.0] {
        if few(&thinned) {
            break;
        }
        thinned = sparser(thinned, tolerance);
    }
    thinned
}

/// Leaves out points that the line passes without them too (Ramer 1972; Douglas and Peucker 1973).
fn straighten(line: &mut Vec<Point>) {
    let mut kept = vec![false; line.len()];
    let mut pieces = vec![(0, line.len().saturating_sub(1))];
    while let Some((from, to)) = pieces.pop() {
        let away = |k: usize| beside(line[k], line[from], line[to]);
        let farthest = (from + 1..to).max_by(|a, b| away(*a).total_cmp(&away(*b)));
        match farthest.filter(|k| away(*k) > BESIDE) {
            Some(middle) => pieces.extend([(from, middle), (middle, to)]),
            None => [from, to].iter().for_each(|end| kept.get_mut(*end).into_iter().for_each(|kept| *kept = true)),
        }
    }
    let mut kept = kept.into_iter();
    line.retain(|_| kept.next().unwrap_or(false));
}

/// The distance of a point from a segment.
fn beside(point: Point, from: Point, to: Point) -> f64 {
    let [along, off] = [[to[0] - from[0], to[1] - from[1]], [point[0] - from[0], point[1] - from[1]]];
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 { ((along[0] * off[0] + along[1] * off[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    distance(off, along.map(|length| share * length))
}

/// Keeps points that lie at least `tolerance` from the one kept before, and both ends.
fn sparser(mut lines: Polylines, tolerance: f64) -> Polylines {
    for line in &mut lines {
        if let [first, .., last] = line[..] {
            let mut kept = first;
            line.retain(|&point| {
                let far = distance(point, kept) >= tolerance;
                if far {
                    kept = point;
                }
                far
            });
            line.insert(0, first);
            line.push(last);
        }
    }
    lines
}

/// Leaves out short pieces of line that run between places where the line has been before.
fn first_visits(lines: Polylines) -> Polylines {
    let mut visited = HashSet::new();
    let mut fresh: Polylines = Vec::new();
    for line in lines {
        let mut open = false;
        let mut before: Option<(Point, bool)> = None;
        for point in line {
            let new = visited.insert(point.map(|length| length.round() as i32));
            if let Some((from, was_new)) = before {
                let draws = new || was_new || distance(from, point) > 3.0;
                match fresh.last_mut() {
                    Some(line) if draws && open => line.push(point),
                    _ if draws => fresh.push(vec![from, point]),
                    _ => {}
                }
                open = draws;
            }
            before = Some((point, new));
        }
    }
    fresh
}

/// At most `most` points, each the largest value of an equally long stretch, at its own time.
///
/// This keeps every peak, however long the series, but not how far the values fall in between. Values that are not finite are left
/// out, and a stretch without any other value is a gap.
pub(crate) fn peaks(time: &[f64], values: &[f64], most: usize) -> Trace {
    let nodes = time.len().min(values.len());
    let stretch = nodes.div_ceil(most.max(1)).max(1);
    let pairs: Vec<[f64; 2]> = time.iter().zip(values).map(|(&t, &value)| [t, value.abs()]).collect();
    pairs
        .chunks(stretch)
        .map(|chunk| {
            let finite = chunk.iter().filter(|[t, value]| drawable(*t) && value.is_finite());
            finite.copied().max_by(|a, b| a[1].total_cmp(&b[1]))
        })
        .collect()
}
