//! Fewer points, the same picture.

use super::geometry::{distance, drawable};
use std::collections::HashSet;

/// Lines as a picture draws them.
type Lines = Vec<Vec<[f64; 2]>>;

/// Leaves out points that lie closer to their predecessor than the eye can tell; where more than `most` are left, also
/// what lies on itself, as in a circle run through a thousand times, and then points a little further apart.
pub(super) fn thin(lines: Lines, most: usize) -> Lines {
    let few = |lines: &Lines| lines.iter().map(Vec::len).sum::<usize>() <= most;
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

/// Keeps points that lie at least `tolerance` from the one kept before, and both ends.
fn sparser(mut lines: Lines, tolerance: f64) -> Lines {
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
fn first_visits(lines: Lines) -> Lines {
    let mut visited = HashSet::new();
    let mut fresh: Lines = Vec::new();
    for line in lines {
        let mut open = false;
        let mut before: Option<([f64; 2], bool)> = None;
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

/// At most `most` points, each the largest value of an equally long stretch at the time where it occurs.
///
/// So no peak is lost, however long the series; what is lost is how far the values fall in between. Values that are
/// not finite are left out, and a stretch without any other value is a gap.
pub(super) fn peaks(time: &[f64], values: &[f64], most: usize) -> Vec<Option<[f64; 2]>> {
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
