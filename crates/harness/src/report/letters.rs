//! The outlines of letters, from a font that the program carries.

use super::canvas::Anchor;
use ttf_parser::{Face, GlyphId, OutlineBuilder};
use zeno::{Command, PathBuilder, Vector};

/// Latin, Greek and the signs of mathematics; see `font/README.md`.
const FONT: &[u8] = include_bytes!("../../font/letters.ttf");

/// Half the height of a digit, in font sizes: text stands with this height at its point.
const MIDDLE: f64 = 0.36;

/// The letters.
pub(super) struct Letters<'a> {
    face: Face<'a>,
}

impl Letters<'_> {
    /// The font; none if it could not be read.
    pub(super) fn new() -> Option<Self> {
        Face::parse(FONT, 0).ok().map(|face| Self { face })
    }

    /// The outline of a line of text at a point (pixels), turned about the point by a quarter where it is upright.
    pub(super) fn outline(&self, text: &str, at: [f64; 2], anchor: Anchor, size: f64, upright: bool) -> Vec<Command> {
        let [x, y] = at;
        // A letter that the font lacks is its empty box.
        let glyphs: Vec<GlyphId> = text.chars().map(|c| self.face.glyph_index(c).unwrap_or_default()).collect();
        let scale = size / f64::from(self.face.units_per_em());
        let advance = |glyph: &GlyphId| scale * f64::from(self.face.glyph_hor_advance(*glyph).unwrap_or(0));
        let width: f64 = glyphs.iter().map(advance).sum();
        let left = match anchor {
            Anchor::Left => x,
            Anchor::Middle => x - 0.5 * width,
            Anchor::Right => x - width,
        };
        let mut pen = Pen { path: Vec::new(), origin: [left, y + MIDDLE * size], scale };
        for glyph in &glyphs {
            self.face.outline_glyph(*glyph, &mut pen);
            pen.origin[0] += advance(glyph);
        }
        if upright { pen.path.into_iter().map(|command| turned(command, at)).collect() } else { pen.path }
    }
}

/// A quarter turn about a point, so that what ran to the right runs upwards.
fn turned(command: Command, at: [f64; 2]) -> Command {
    let [x, y] = at.map(|length| length as f32);
    let turn = |p: Vector| Vector::new(x + (p.y - y), y - (p.x - x));
    match command {
        Command::MoveTo(p) => Command::MoveTo(turn(p)),
        Command::LineTo(p) => Command::LineTo(turn(p)),
        Command::QuadTo(a, p) => Command::QuadTo(turn(a), turn(p)),
        Command::CurveTo(a, b, p) => Command::CurveTo(turn(a), turn(b), turn(p)),
        Command::Close => Command::Close,
    }
}

/// Writes a letter at its origin; upwards in the font is downwards in a picture.
struct Pen {
    path: Vec<Command>,
    origin: [f64; 2],
    scale: f64,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> [f32; 2] {
        let [left, base] = self.origin;
        [left + self.scale * f64::from(x), base - self.scale * f64::from(y)].map(|length| length as f32)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let to = self.at(x, y);
        self.path.move_to(to);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.at(x, y);
        self.path.line_to(to);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (control, to) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(control, to);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (first, second, to) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.curve_to(first, second, to);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
