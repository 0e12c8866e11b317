//! Marks as SVG, and text as HTML and SVG take it. Coordinates are whole numbers, of which a unit of the picture has [`SCALE`].

use super::canvas::{Anchor, DOT, Mark, Point, Shape};
use super::look::{Ink, LOOKS};
use std::fmt::Write;

const SCALE: f64 = 10.0;
/// How near a pointer must come to a point.
const TIP: f64 = 6.0;

/// A length of the picture in whole numbers of its SVG; saturates, and every caller stays within the frame.
pub(crate) fn units(length: f64) -> i32 {
    (length * SCALE).round() as i32
}

/// Dashes as the value of an attribute.
pub(crate) fn dashes(ink: Ink, scale: f64) -> String {
    ink.dashes().iter().map(|length| format!("{:.0}", length * scale)).collect::<Vec<_>>().join(" ")
}

/// The marks as elements.
pub(crate) fn shapes(marks: &[Mark]) -> String {
    marks.iter().map(shape).collect()
}

fn shape(Mark { shape, ink, opacity }: &Mark) -> String {
    // Which run a shape belongs to, for the buttons of the page.
    let run = match ink {
        Ink::Method(method) => format!(" data-run=\"{}\"", method % LOOKS),
        _ => String::new(),
    };
    let colour = ink.colour();
    let seen = if *opacity < 1.0 { format!(" opacity=\"{opacity}\"") } else { String::new() };
    match shape {
        Shape::Line { points, width } => {
            let dashes = match &dashes(*ink, SCALE)[..] {
                "" => String::new(),
                dashes => format!(" stroke-dasharray=\"{dashes}\""),
            };
            let (width, points) = (units(*width), corners(points));
            format!(
                "<polyline fill=\"none\"{seen}{run} stroke=\"{colour}\"{dashes} stroke-width=\"{width}\" \
                 points=\"{points}\"/>\n"
            )
        }
        Shape::Area(points) => format!("<polygon{seen}{run} fill=\"{colour}\" points=\"{}\"/>\n", corners(points)),
        Shape::Cells(cells) => {
            let cells =
                cells.iter().map(|corners| corners.as_flattened().iter().copied().map(units).collect::<Vec<_>>());
            let path: String = cells.map(|c| format!("M{} {}V{}H{}V{1}z", c[0], c[1], c[3], c[2])).collect();
            format!("<path fill=\"{colour}\" shape-rendering=\"crispEdges\" d=\"{path}\"/>\n")
        }
        // Lines without length, whose round ends are the dots.
        Shape::Dots(places) => {
            let path: String = places.iter().map(|p| format!("M{} {}h0", units(p[0]), units(p[1]))).collect();
            let width = units(DOT);
            format!("<path stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\" d=\"{path}\"/>\n")
        }
        Shape::Text { text, at, anchor, size, upright } => {
            let ([x, y], text) = (at.map(units), escape(text));
            let anchor = match anchor {
                Anchor::Left => "start",
                Anchor::Middle => "middle",
                Anchor::Right => "end",
            };
            let turn = if *upright { format!(" transform=\"rotate(270, {x}, {y})\"") } else { String::new() };
            // Half the height of a digit puts the digits of a tick onto its height.
            format!(
                "<text x=\"{x}\" y=\"{y}\" dy=\"0.36em\" text-anchor=\"{anchor}\" font-family=\"sans-serif\" \
                 font-size=\"{}\" fill=\"{colour}\"{turn}>\n{text}\n</text>\n",
                size * SCALE
            )
        }
        Shape::Tip { text, at } => format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" pointer-events=\"all\"><title>{}</title></circle>\n",
            units(at[0]),
            units(at[1]),
            units(TIP),
            escape(text)
        ),
    }
}

fn corners(points: &[Point]) -> String {
    points.iter().fold(String::new(), |mut text, point| {
        let _ = write!(text, "{},{} ", units(point[0]), units(point[1]));
        text
    })
}

/// The text with the characters that mean something to HTML and XML escaped, and those that XML forbids replaced.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars().map(allowed) {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A label for a picture: one line, allowed characters only, cut to `most` characters.
pub(crate) fn label(text: &str, most: usize) -> String {
    let mut label: Vec<char> = text.chars().map(|c| if c.is_whitespace() { ' ' } else { allowed(c) }).collect();
    if label.len() > most {
        label.truncate(most.saturating_sub(1));
        label.push('…');
    }
    label.into_iter().collect()
}

fn allowed(c: char) -> char {
    match c {
        '\t' | '\n' | '\r' => c,
        c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => '\u{FFFD}',
        c => c,
    }
}
