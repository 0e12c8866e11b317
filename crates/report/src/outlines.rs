//! Marks as outlines and strokes, letters among them, from a font that the program carries.

use super::ReportError;
use super::canvas::{Anchor, DOT, Point, Shape};
use super::look::regular;
use ttf_parser::{Face, GlyphId, OutlineBuilder};
use zeno::{Command, PathBuilder, Vector};

/// Latin, Greek and the signs of mathematics; see `font/README.md`.
const FONT: &[u8] = include_bytes!("../font/letters.ttf");

/// Half the height of a digit, in font sizes: text stands with this height at its point.
const MIDDLE: f64 = 0.36;

/// Draws shapes as paths.
pub(crate) struct Outliner<'a> {
    face: Face<'a>,
    /// Units of the paths to one of the picture.
    scale: f64,
}

impl Outliner<'_> {
    pub(crate) fn new(scale: f64) -> Result<Self, ReportError> {
        let face = Face::parse(FONT, 0).map_err(|error| ReportError::Draw(format!("the embedded font: {error}")))?;
        Ok(Self { face, scale })
    }

    /// The path of a shape: the path of a pen for a line, else the outline to be filled.
    pub(crate) fn path(&self, shape: &Shape) -> Vec<Command> {
        let mut path = Vec::new();
        let mut outline = |points: &[Point], closed: bool| {
            for (k, point) in points.iter().enumerate() {
                let point = point.map(|length| (length * self.scale) as f32);
                if k == 0 {
                    path.move_to(point)
                } else {
                    path.line_to(point)
                };
            }
            if closed {
                path.close();
            }
        };
        match shape {
            Shape::Line { points, .. } => outline(points, false),
            Shape::Area(points) => outline(points, true),
            Shape::Cells(cells) => cells.iter().for_each(|[[x, y], [right, top]]| {
                outline(&[[*x, *y], [*x, *top], [*right, *top], [*right, *y]], true);
            }),
            Shape::Dots(places) => places.iter().for_each(|[x, y]| {
                let dot = regular(8, 0.5 * DOT, 0.0);
                outline(&dot.iter().map(|[dx, dy]| [x + dx, y + dy]).collect::<Vec<_>>(), true);
            }),
            Shape::Text { text, at, anchor, size, upright } => {
                return self.letters(text, at.map(|length| length * self.scale), *anchor, size * self.scale, *upright);
            }
            Shape::Tip { .. } => {}
        }
        path
    }

    fn letters(&self, text: &str, at: Point, anchor: Anchor, size: f64, upright: bool) -> Vec<Command> {
        // A letter that the font lacks is its empty box.
        let glyphs: Vec<GlyphId> = text.chars().map(|c| self.face.glyph_index(c).unwrap_or_default()).collect();
        let scale = size / f64::from(self.face.units_per_em());
        let advance = |glyph: &GlyphId| scale * f64::from(self.face.glyph_hor_advance(*glyph).unwrap_or(0));
        let width: f64 = glyphs.iter().map(advance).sum();
        let along = match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::Right => -width,
        };
        let mut pen = Pen { path: Vec::new(), at, origin: [along, MIDDLE * size], scale, upright };
        for glyph in &glyphs {
            self.face.outline_glyph(*glyph, &mut pen);
            pen.origin[0] += advance(glyph);
        }
        pen.path
    }
}

/// Writes a letter at its origin, which is relative to the point of the text; upwards in the font is downwards in a picture.
struct Pen {
    path: Vec<Command>,
    at: Point,
    origin: Point,
    scale: f64,
    upright: bool,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> Vector {
        let [x, y] = [self.origin[0] + self.scale * f64::from(x), self.origin[1] - self.scale * f64::from(y)];
        let [right, down] = if self.upright { [y, -x] } else { [x, y] };
        Vector::new((self.at[0] + right) as f32, (self.at[1] + down) as f32)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.push(Command::MoveTo(self.place(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.push(Command::LineTo(self.place(x, y)));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.push(Command::QuadTo(self.place(x1, y1), self.place(x, y)));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.push(Command::CurveTo(self.place(x1, y1), self.place(x2, y2), self.place(x, y)));
    }

    fn close(&mut self) {
        self.path.push(Command::Close);
    }
}
