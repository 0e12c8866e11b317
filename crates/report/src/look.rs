//! How methods are told apart: colour, dashes and a marker, so that overlapping curves and any eye can.

use super::canvas::Point;

/// Colours of Okabe and Ito, darker if a thin line would not stand out on white, and as far apart to a colour-blind eye. The last is the
/// colour of the text. On a dark page `style.css` restores the colours of Okabe and Ito themselves.
const COLOURS: [&str; 7] = ["#005B96", "#B04400", "#008F66", "#CF6FA5", "#C08600", "#3C9CDA", "currentColor"];

/// The colour of text on a ground of the picture's own.
pub(crate) const TEXT: &str = "#1d2329";

/// Dashes in picture units; the first method is a solid line, and the wide one that the others lie on.
const DASHES: [&[f64]; 7] =
    [&[], &[7.0, 3.5], &[2.2, 2.6], &[9.0, 3.0, 2.2, 3.0], &[13.0, 4.0], &[4.5, 2.5], &[9.0, 2.6, 2.2, 2.6, 2.2, 2.6]];

/// How many methods have a look of their own.
pub(crate) const LOOKS: usize = COLOURS.len() * DASHES.len();

/// What to draw with.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Ink {
    /// The colour of text.
    Text,
    /// The colour of text, thin dashes: the exact motion.
    Exact,
    /// The look of a method.
    Method(usize),
    /// A colour such as `#1d2329`.
    Colour(&'static str),
}

impl Ink {
    /// The colour. `currentColor` means the colour of the text around the picture.
    pub(crate) fn colour(self) -> &'static str {
        match self {
            Self::Text | Self::Exact => "currentColor",
            Self::Method(method) => COLOURS[method % COLOURS.len()],
            Self::Colour(colour) => colour,
        }
    }

    /// Red, green and blue on a light ground.
    pub(crate) fn rgb(self) -> [u8; 3] {
        let number = |colour: &str| u32::from_str_radix(colour.strip_prefix('#')?, 16).ok();
        let [_, rgb @ ..] = number(self.colour()).or_else(|| number(TEXT)).unwrap_or_default().to_be_bytes();
        rgb
    }

    /// The dashes; none for a solid line.
    pub(crate) fn dashes(self) -> &'static [f64] {
        match self {
            Self::Text | Self::Colour(_) => &[],
            Self::Exact => &[5.0, 3.5],
            // When the colours start again, the dashes do not.
            Self::Method(method) => DASHES[(method + method / COLOURS.len()) % DASHES.len()],
        }
    }
}

/// The width of a method's line.
pub(crate) fn width(method: usize) -> f64 {
    if method == 0 { 2.8 } else { 1.6 }
}

/// The outline of a method's marker about the origin.
pub(crate) fn marker(method: usize) -> Vec<Point> {
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
pub(crate) fn cross() -> Vec<Point> {
    star(4, 9.0, 2.0, 45.0)
}

/// A regular polygon whose first corner lies in the direction given in degrees.
pub(crate) fn regular(corners: u32, radius: f64, first: f64) -> Vec<Point> {
    (0..corners).map(|corner| polar(radius, first + 360.0 * f64::from(corner) / f64::from(corners))).collect()
}

fn star(points: u32, outer: f64, inner: f64, first: f64) -> Vec<Point> {
    let turn = 180.0 / f64::from(points);
    (0..2 * points).map(|k| polar(if k % 2 == 0 { outer } else { inner }, first + turn * f64::from(k))).collect()
}

fn polar(radius: f64, degrees: f64) -> Point {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [radius * cos, radius * sin]
}
