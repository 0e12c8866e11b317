//! A picture as pixels: the marks of its canvas, with the look that its SVG has on a light ground.

use super::canvas::{CanvasMark, Ink};
use super::letters::Letters;
use super::look;
use super::png;
use zeno::{Cap, Command, Join, PathBuilder, Scratch, Stroke, Style};

/// A picture has so many pixels at most, each of which takes six bytes and more while it is drawn.
pub const MOST_PIXELS: f64 = 1.5e8;

/// The picture as the bytes of a PNG file, with so many pixels to a unit of the picture; the file says how many to an inch.
pub(super) fn png(size: [f64; 2], marks: &[CanvasMark], scale: f64, dpi: f64) -> Result<Vec<u8>, String> {
    let [width, height] = size.map(|length| (length * scale).round());
    if width * height > MOST_PIXELS {
        return Err(format!("{width} x {height} pixels are more than {MOST_PIXELS:.1e}"));
    }
    let [width, height] = [width, height].map(|length| length as u32);
    let mut pixels = Pixels::new(width as usize, height as usize);
    let letters = Letters::new().ok_or("the embedded font cannot be read")?;
    for mark in marks {
        draw(&mut pixels, &letters, mark, scale);
    }
    Ok(png::encode([width, height], &pixels.colours, dpi))
}

fn draw(pixels: &mut Pixels, letters: &Letters<'_>, mark: &CanvasMark, scale: f64) {
    match mark {
        CanvasMark::Line { points, ink, opacity, width } => {
            let dashes: Vec<f32> = dashes(*ink).iter().map(|length| (length * scale) as f32).collect();
            let mut stroke = Stroke::new((width * scale) as f32);
            stroke.join(Join::Round).cap(Cap::Butt).dash(&dashes, 0.0);
            pixels.draw(&path(points, false, scale), stroke, *ink, *opacity);
        }
        CanvasMark::Area { points, ink, opacity } => {
            pixels.draw(&path(points, true, scale), Style::default(), *ink, *opacity);
        }
        CanvasMark::Text { text, at, anchor, size, upright } => {
            let at = at.map(|length| length * scale);
            let outline = letters.outline(text, at, *anchor, size * scale, *upright);
            pixels.draw(&outline, Style::default(), Ink::Text, 1.0);
        }
    }
}

fn path(points: &[[f64; 2]], closed: bool, scale: f64) -> Vec<Command> {
    let mut path = Vec::with_capacity(points.len() + 1);
    for (k, point) in points.iter().enumerate() {
        let point = point.map(|length| (length * scale) as f32);
        if k == 0 {
            path.move_to(point)
        } else {
            path.line_to(point)
        };
    }
    if closed {
        path.close();
    }
    path
}

/// The dashes of an ink (units of the picture).
pub(super) fn dashes(ink: Ink) -> &'static [f64] {
    match ink {
        Ink::Text => &[],
        Ink::Exact => &look::EXACT,
        Ink::Method(method) => look::dashes(method),
    }
}

pub(super) fn colour(ink: Ink) -> [u8; 3] {
    let own = match ink {
        Ink::Text | Ink::Exact => None,
        Ink::Method(method) => hexadecimal(look::colour(method)),
    };
    own.or_else(|| hexadecimal(look::TEXT)).unwrap_or_default()
}

/// A colour such as `#1d2329`; none of a word such as `currentColor`.
fn hexadecimal(colour: &str) -> Option<[u8; 3]> {
    let number = u32::from_str_radix(colour.strip_prefix('#')?, 16).ok()?;
    let [_, red, green, blue] = number.to_be_bytes();
    Some([red, green, blue])
}

/// Opaque pixels, row by row, white at first.
struct Pixels {
    width: usize,
    height: usize,
    colours: Vec<[u8; 3]>,
    scratch: Scratch,
}

impl Pixels {
    fn new(width: usize, height: usize) -> Self {
        Self { width, height, colours: vec![[255; 3]; width * height], scratch: Scratch::new() }
    }

    /// Lays an ink over what there is, as far as an outline or its stroke covers each pixel.
    fn draw<'a>(&mut self, path: &[Command], style: impl Into<Style<'a>>, ink: Ink, opacity: f64) {
        if path.is_empty() {
            return;
        }
        let (coverage, place) = zeno::Mask::with_scratch(path, &mut self.scratch).style(style).render();
        let (ink, opacity) = (colour(ink), (256.0 * opacity) as i32);
        for (y, row) in (i64::from(place.top)..).zip(coverage.chunks_exact((place.width as usize).max(1))) {
            let Some(y) = usize::try_from(y).ok().filter(|y| *y < self.height) else { continue };
            for (x, covered) in (i64::from(place.left)..).zip(row).filter(|(_, covered)| **covered > 0) {
                let Some(x) = usize::try_from(x).ok().filter(|x| *x < self.width) else { continue };
                let share = i32::from(*covered) * opacity / 256;
                for (below, ink) in self.colours[y * self.width + x].iter_mut().zip(ink) {
                    let (here, over) = (i32::from(*below), i32::from(ink));
                    // Between the two, so it is a byte again.
                    *below = (here + (over - here) * share / 255) as u8;
                }
            }
        }
    }
}
