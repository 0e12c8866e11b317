use super::crossing::SeriesEnd;

/// The place `(X, Y)` in axes of this heading, from a place on the plane.
#[inline(always)]
fn turned_back([x, y]: [f64; 2], heading: f64) -> [f64; 2] {
    let (sin, cos) = heading.sin_cos();
    [cos * x + sin * y, cos * y - sin * x]
}

/// The place `(X, Y)` where a step begins, counted from `center`; without one, from there.
#[inline(always)]
pub(crate) fn place(center: Option<[f64; 2]>, q0: &[f64; 3]) -> [f64; 2] {
    center.map_or([0.0; 2], |[x, y]| turned_back([q0[0] - x, q0[1] - y], q0[2]))
}

/// The increment of the coordinates to the end of an interval, from the heading and the place `(X, Y)` at its beginning.
#[inline(always)]
pub(crate) fn increment(heading: f64, [x0, y0]: [f64; 2], crossed: &SeriesEnd) -> [f64; 3] {
    let SeriesEnd { end: [_, _, y, x], turn } = *crossed;
    // Both places in the axes of the beginning: what is common to them is not turned.
    let [x, y] = turned_back([x, y], -turn);
    let [dx, dy] = turned_back([x - x0, y - y0], -heading);
    [dx, dy, turn]
}
