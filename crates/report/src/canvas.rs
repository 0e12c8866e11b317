//! What pictures are drawn on: a list of marks, of which the files of every format are made.

use super::look::{self, Ink};

/// A point of a picture: units to the right of its upper left corner, and below it.
pub(crate) type Point = [f64; 2];

/// Where text stands relative to its point.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Anchor {
    Left,
    Middle,
    Right,
}

/// Something drawn.
#[derive(Debug, Clone)]
pub(crate) struct Mark {
    pub(crate) shape: Shape,
    pub(crate) ink: Ink,
    pub(crate) opacity: f64,
}

#[derive(Debug, Clone)]
pub(crate) enum Shape {
    Line {
        points: Vec<Point>,
        width: f64,
    },
    Area(Vec<Point>),
    /// Rectangles without a gap between them, each by two of its corners.
    Cells(Vec<[Point; 2]>),
    Dots(Vec<Point>),
    /// Upright: read from below to above.
    Text {
        text: String,
        at: Point,
        anchor: Anchor,
        size: f64,
        upright: bool,
    },
    /// What a pointer is told over a point.
    Tip {
        text: String,
        at: Point,
    },
}

/// The diameter of a dot.
pub(crate) const DOT: f64 = 1.7;

/// What a picture is drawn on.
#[derive(Debug, Clone, Default)]
pub(crate) struct Canvas {
    pub(crate) marks: Vec<Mark>,
}

impl Canvas {
    pub(crate) fn draw(&mut self, shape: Shape, ink: Ink, opacity: f64) {
        self.marks.push(Mark { shape, ink, opacity });
    }

    pub(crate) fn line(&mut self, points: impl Into<Vec<Point>>, ink: Ink, opacity: f64, width: f64) {
        self.draw(Shape::Line { points: points.into(), width }, ink, opacity);
    }

    /// An outline about a point, filled.
    pub(crate) fn fill(&mut self, outline: &[Point], [x, y]: Point, ink: Ink, opacity: f64) {
        self.draw(Shape::Area(outline.iter().map(|[dx, dy]| [x + dx, y + dy]).collect()), ink, opacity);
    }

    /// The marker of a method at a point.
    pub(crate) fn marker(&mut self, method: usize, at: Point) {
        self.fill(&look::marker(method), at, Ink::Method(method), 1.0);
    }

    /// The mark at a point where the line of a method stops because its run failed.
    pub(crate) fn cross(&mut self, method: usize, at: Point) {
        self.fill(&look::cross(), at, Ink::Method(method), 1.0);
    }

    /// A line of text, centred vertically on the point.
    pub(crate) fn text(&mut self, text: &str, at: Point, anchor: Anchor, size: f64) {
        self.draw(Shape::Text { text: text.to_owned(), at, anchor, size, upright: false }, Ink::Text, 1.0);
    }
}

/// About how wide a text is, its font being whichever the reader has.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    let narrow = |c| matches!(c, '⁰'..='⁹' | '⁻' | '¹' | '²' | '³' | '.' | 'i' | 'l');
    text.chars().map(|c| if narrow(c) { 0.38 } else { 0.58 }).sum::<f64>() * size
}
