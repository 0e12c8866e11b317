use super::Origin;
use super::crossing::SeriesEnd;

/// The place `(X, Y)` in axes of this heading, from a place on the plane.
#[inline(always)]
fn turned_back([x, y]: [f64; 2], heading: f64) -> [f64; 2] {
    let (sin, cos) = heading.sin_cos();
    [cos * x + sin * y, cos * y - sin * x]
}

/// The place `(X, Y)` where a step begins.
#[inline(always)]
pub(crate) fn place(origin: Origin, q0: &[f64; 3]) -> [f64; 2] {
    match origin {
        Origin::Coordinates => [q0[0], q0[1]],
        Origin::Point(center) => turned_back([q0[0] - center[0], q0[1] - center[1]], q0[2]),
        Origin::Anywhere => [0.0; 2],
    }
}

/// The increment of the coordinates from `q0`, with the place `(X, Y)` there, to the end of an interval.
#[inline(always)]
pub(crate) fn increment(origin: Origin, q0: &[f64; 3], [x0, y0]: [f64; 2], crossed: &SeriesEnd) -> [f64; 3] {
    let SeriesEnd { end: [_, _, y, x], turn } = *crossed;
    let [dx, dy] = match origin {
        Origin::Coordinates => [x - x0, y - y0],
        Origin::Point(_) | Origin::Anywhere => {
            // Both places in the axes of the beginning: what is common to them is not turned.
            let [x, y] = turned_back([x, y], -turn);
            turned_back([x - x0, y - y0], -q0[2])
        }
    };
    [dx, dy, turn]
}
