use super::root::RootPoint;

/// Intervals, each with a change of sign, of a function on `[0, 1]` of which some values are known.
///
/// `points` are in order, reach a little beyond both ends, and hold no value that is not a number. A single crossing between neighbours
/// shows by the signs. Two crossings show no sign, but a dip: if the size of three neighbours of one sign is least in the middle, and could
/// fall to zero, the least value is searched for until it changes sign.
pub(super) fn isolate(points: &[RootPoint], mut f: impl FnMut(f64) -> f64) -> Vec<(RootPoint, RootPoint)> {
    let mut found = Vec::new();
    for (i, pair) in points.windows(2).enumerate() {
        let [a, b] = [pair[0], pair[1]];
        if a.at < 0.0 || b.at > 1.0 {
            continue;
        }
        // A zero at the end of an interval is a crossing if the function goes on to the other side.
        let after = if b.value == 0.0 { points.get(i + 2).map_or(-a.value, |next| next.value) } else { b.value };
        if a.value * after.signum() < 0.0 && after != 0.0 {
            found.push((a, b));
        }
    }
    for triple in points.windows(3) {
        if let Some((from, least, to)) = dip([triple[0], triple[1], triple[2]], &mut f) {
            found.extend([(from, least), (least, to)]);
        }
    }
    found.sort_by(|one, other| f64::total_cmp(&one.0.at, &other.0.at));
    found
}

/// The part in `[0, 1]` of an interval of one sign, with a point in it of the other, if there is one.
fn dip([a, b, c]: [RootPoint; 3], f: &mut impl FnMut(f64) -> f64) -> Option<(RootPoint, RootPoint, RootPoint)> {
    let side = b.value.signum();
    let [left, middle, right] = [a, b, c].map(|point| side * point.value);
    // The parabola through the points dips below the middle by an eighth of this at most.
    let fall = f64::max(left, right) - middle;
    let may = middle > 0.0 && left >= middle && right > middle && middle <= fall;
    if !may || b.at < 0.0 || b.at > 1.0 {
        return None;
    }
    // The ends of the step are among the points.
    let (from, to) = (if a.at < 0.0 { b } else { a }, if c.at > 1.0 { b } else { c });
    let least = negative([from.at, to.at], |at| side * f(at))?;
    Some((from, RootPoint { at: least.at, value: side * least.value }, to))
}

/// A point between the ends at which the function is negative, on the way to its least value: by the golden section, to the half of the
/// digits that a flat place has.
fn negative([mut from, mut to]: [f64; 2], mut f: impl FnMut(f64) -> f64) -> Option<RootPoint> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut point = |at: f64| RootPoint { at, value: f(at) };
    let (mut one, mut two) = (point(to - GOLDEN * (to - from)), point(from + GOLDEN * (to - from)));
    while to - from > 1e-8 {
        let found = [one, two].into_iter().find(|point| point.value < 0.0);
        if found.is_some() || one.value.is_nan() || two.value.is_nan() {
            return found;
        }
        if one.value < two.value {
            (to, two) = (two.at, one);
            one = point(to - GOLDEN * (to - from));
        } else {
            (from, one) = (one.at, two);
            two = point(from + GOLDEN * (to - from));
        }
    }
    None
}
