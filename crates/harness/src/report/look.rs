//! How methods are told apart: colour, dashes and a marker, so that overlapping curves and any eye can.

/// Colours of Okabe and Ito, darker where a thin line would not stand out on white, and as far apart to a colour-blind eye;
/// the last is that of the text. On a dark page `style.css` puts the colours of Okabe and Ito themselves in their places.
const COLOURS: [&str; 7] = ["#005B96", "#B04400", "#008F66", "#CF6FA5", "#C08600", "#3C9CDA", "currentColor"];

/// The colour of text on a ground of the picture's own.
pub(super) const TEXT: &str = "#1d2329";

/// Dashes in picture units; the first method is a solid line, and the wide one that the others lie on.
const DASHES: [&[f64]; 7] =
    [&[], &[7.0, 3.5], &[2.2, 2.6], &[9.0, 3.0, 2.2, 3.0], &[13.0, 4.0], &[4.5, 2.5], &[9.0, 2.6, 2.2, 2.6, 2.2, 2.6]];

/// The dashes of what is known without computing.
pub(super) const EXACT: [f64; 2] = [5.0, 3.5];

/// How many methods have a look of their own.
pub(super) const LOOKS: usize = COLOURS.len() * DASHES.len();

/// The colour of a method.
pub(super) fn colour(method: usize) -> &'static str {
    COLOURS[method % COLOURS.len()]
}

/// The dashes of a method; none for a solid line.
pub(super) fn dashes(method: usize) -> &'static [f64] {
    // When the colours start again, the dashes do not.
    DASHES[(method + method / COLOURS.len()) % DASHES.len()]
}

/// Dashes as the value of an SVG attribute.
pub(super) fn written(dashes: &[f64], scale: f64) -> String {
    dashes.iter().map(|length| format!("{:.0}", length * scale)).collect::<Vec<_>>().join(" ")
}

/// The width of a method's line.
pub(super) fn width(method: usize) -> f64 {
    if method == 0 { 2.8 } else { 1.6 }
}

/// The outline of a method's marker about the origin.
pub(super) fn marker(method: usize) -> Vec<[f64; 2]> {
    match (method + method / COLOURS.len()) % 7 {
        0 => regular(12, 3.8, 0.0),
        1 => regular(4, 4.6, 45.0),
        2 => regular(3, 5.2, -90.0),
        3 => regular(4, 5.2, 0.0),
        4 => regular(3, 5.2, 90.0),
        5 => star(4, 5.4, 1.9, 45.0),
        _ => star(5, 5.6, 2.3, -90.0),
    }
}

/// The outline, about the origin, of the cross where a line stops because its run failed: larger than any marker.
pub(super) fn cross() -> Vec<[f64; 2]> {
    star(4, 9.0, 2.0, 45.0)
}

/// A regular polygon whose first corner lies in the direction given in degrees.
pub(super) fn regular(corners: u32, radius: f64, first: f64) -> Vec<[f64; 2]> {
    (0..corners).map(|corner| polar(radius, first + 360.0 * f64::from(corner) / f64::from(corners))).collect()
}

fn star(points: u32, outer: f64, inner: f64, first: f64) -> Vec<[f64; 2]> {
    let turn = 180.0 / f64::from(points);
    (0..2 * points).map(|k| polar(if k % 2 == 0 { outer } else { inner }, first + turn * f64::from(k))).collect()
}

fn polar(radius: f64, degrees: f64) -> [f64; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [radius * cos, radius * sin]
}

/// A sample of a method's line and marker for the page, as a small SVG.
pub(super) fn key(method: usize) -> String {
    let points: Vec<String> = marker(method).iter().map(|[x, y]| format!("{:.1},{:.1}", x + 14.0, y + 6.0)).collect();
    format!(
        "<svg class=\"key\" viewBox=\"0 0 28 12\" aria-hidden=\"true\"><path d=\"M0 6H28\" stroke=\"{colour}\" \
         stroke-width=\"{}\" stroke-dasharray=\"{}\"/><polygon fill=\"{colour}\" points=\"{}\"/></svg>",
        width(method),
        written(dashes(method), 1.0),
        points.join(" "),
        colour = colour(method),
    )
}
