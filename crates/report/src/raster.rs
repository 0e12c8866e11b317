//! Marks as the pixels of a PNG file, with the look that they have as SVG on a light ground.

use super::ReportError;
use super::canvas::{Mark, Shape};
use super::look::Ink;
use super::outlines::Outliner;
use miniz_oxide::deflate::compress_to_vec_zlib;
use zeno::{Cap, Command, Join, Scratch, Stroke, Style};

/// Maximum number of pixels of a picture. Drawing takes more than six bytes for each.
pub const MOST_PIXELS: f64 = 1.5e8;

/// How hard to compress: pictures are mostly ground, of which the lower levels make little already.
pub(crate) const LEVEL: u8 = 6;
/// The filter `Up`.
const UP: u8 = 2;
const METRES_PER_INCH: f64 = 0.0254;

/// The bytes of a PNG file with `scale` pixels to a unit of the picture. The file records `dpi` (pixels to an inch).
pub(crate) fn png(size: [f64; 2], marks: &[Mark], scale: f64, dpi: f64) -> Result<Vec<u8>, ReportError> {
    let [width, height] = size.map(|length| (length * scale).round());
    if width * height > MOST_PIXELS {
        return Err(ReportError::Draw(format!("{width} x {height} pixels are more than {MOST_PIXELS:.1e}")));
    }
    let [width, height] = [width, height].map(|length| length as u32);
    let mut pixels = Pixels::new(width as usize, height as usize);
    let outliner = Outliner::new(scale)?;
    for Mark { shape, ink, opacity } in marks {
        let path = outliner.path(shape);
        if let Shape::Line { width, .. } = shape {
            let dashes: Vec<f32> = ink.dashes().iter().map(|length| (length * scale) as f32).collect();
            let mut stroke = Stroke::new((width * scale) as f32);
            stroke.join(Join::Round).cap(Cap::Butt).dash(&dashes, 0.0);
            pixels.draw(&path, stroke, *ink, *opacity);
        } else {
            pixels.draw(&path, Style::default(), *ink, *opacity);
        }
    }
    Ok(encode([width, height], &pixels.colours, dpi))
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
        let (ink, opacity) = (ink.rgb(), (256.0 * opacity) as i32);
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

/// The file (ISO/IEC 15948): eight bits a colour, each row as its difference from the one above.
fn encode([width, height]: [u32; 2], colours: &[[u8; 3]], dpi: f64) -> Vec<u8> {
    let row = 3 * width as usize;
    let mut filtered = Vec::with_capacity((row + 1) * height as usize);
    let mut above = vec![0_u8; row];
    for line in colours.as_flattened().chunks_exact(row.max(1)) {
        filtered.push(UP);
        filtered.extend(line.iter().zip(&above).map(|(here, above)| here.wrapping_sub(*above)));
        above.copy_from_slice(line);
    }
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    // Eight bits, colours without transparency, the one compression and the one set of filters there are, no interlacing.
    header.extend([8, 2, 0, 0, 0]);
    // The resolution across and upwards, in pixels to the metre.
    let resolution = ((dpi / METRES_PER_INCH).round() as u32).to_be_bytes();
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut file, b"IHDR", &header);
    chunk(&mut file, b"pHYs", &[&resolution[..], &resolution, &[1]].concat());
    chunk(&mut file, b"IDAT", &compress_to_vec_zlib(&filtered, LEVEL));
    chunk(&mut file, b"IEND", &[]);
    file
}

/// A chunk: its length, its kind, its content, and a checksum of the latter two.
fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], content: &[u8]) {
    // A picture of a page is far from four thousand million bytes.
    file.extend((content.len() as u32).to_be_bytes());
    let start = file.len();
    file.extend(kind);
    file.extend(content);
    file.extend(crc32fast::hash(&file[start..]).to_be_bytes());
}
