//! A picture as a PDF file of one page: lines and outlines, which a printer draws as finely as it can.

use super::canvas::CanvasMark;
use super::letters::Letters;
use super::raster::{colour, dashes};
use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use zeno::Command;

/// Points of 1/72 inch to a unit of the picture, of which an inch has 96.
const POINTS: f64 = 0.75;
/// How hard to compress.
const LEVEL: u8 = 6;

/// The picture as the bytes of a PDF file, so many times as large as it was drawn.
pub(super) fn file(size: [f64; 2], title: &str, marks: &[CanvasMark], scale: f64) -> Result<Vec<u8>, String> {
    let letters = Letters::new().ok_or("the embedded font cannot be read")?;
    let mut content = Content::new();
    // Upwards in a PDF is downwards in a picture.
    let points = POINTS * scale;
    content.transform([points, 0.0, 0.0, -points, 0.0, points * size[1]].map(|x| x as f32));
    for mark in marks {
        draw(&mut content, &letters, mark);
    }
    let [catalog, pages, page, contents, info] = [1, 2, 3, 4, 5].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    let [width, height] = size.map(|length| (points * length) as f32);
    let mut sheet = pdf.page(page);
    sheet.parent(pages).media_box(Rect::new(0.0, 0.0, width, height)).contents(contents);
    sheet.resources();
    sheet.finish();
    let packed = compress_to_vec_zlib(&content.finish(), LEVEL);
    pdf.stream(contents, &packed).filter(Filter::FlateDecode);
    let mut information = pdf.document_info(info);
    information.title(TextStr(title));
    information.pair(Name(b"Producer"), TextStr("noslip"));
    information.finish();
    Ok(pdf.finish())
}

fn draw(content: &mut Content, letters: &Letters<'_>, mark: &CanvasMark) {
    match mark {
        CanvasMark::Line { points, ink, opacity, width } => {
            let [red, green, blue] = on_white(colour(*ink), *opacity);
            content.set_stroke_rgb(red, green, blue).set_line_width(*width as f32);
            content.set_dash_pattern(dashes(*ink).iter().map(|length| *length as f32), 0.0);
            outline(content, points);
            content.stroke();
        }
        CanvasMark::Area { points, ink, opacity } => {
            let [red, green, blue] = on_white(colour(*ink), *opacity);
            content.set_fill_rgb(red, green, blue);
            outline(content, points);
            content.close_path().fill_nonzero();
        }
        CanvasMark::Text { text, at, anchor, size, upright } => {
            let [red, green, blue] = on_white(colour(super::canvas::Ink::Text), 1.0);
            content.set_fill_rgb(red, green, blue);
            written(content, &letters.outline(text, *at, *anchor, *size, *upright));
            content.fill_nonzero();
        }
    }
}

/// What an ink looks like on a white ground.
fn on_white(ink: [u8; 3], opacity: f64) -> [f32; 3] {
    ink.map(|part| (1.0 - opacity * (1.0 - f64::from(part) / 255.0)) as f32)
}

fn outline(content: &mut Content, points: &[[f64; 2]]) {
    for (k, [x, y]) in points.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        if k == 0 {
            content.move_to(x, y)
        } else {
            content.line_to(x, y)
        };
    }
}

/// The outlines of letters; a PDF has no curves of second degree.
fn written(content: &mut Content, path: &[Command]) {
    let (mut x, mut y) = (0.0, 0.0);
    for command in path {
        match command {
            Command::MoveTo(p) => drop(content.move_to(p.x, p.y)),
            Command::LineTo(p) => drop(content.line_to(p.x, p.y)),
            Command::QuadTo(a, p) => {
                let third = |from: f32, to: f32| from + 2.0 / 3.0 * (to - from);
                content.cubic_to(third(x, a.x), third(y, a.y), third(p.x, a.x), third(p.y, a.y), p.x, p.y);
            }
            Command::CurveTo(a, b, p) => drop(content.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y)),
            Command::Close => drop(content.close_path()),
        }
        if let Command::MoveTo(p) | Command::LineTo(p) | Command::QuadTo(_, p) | Command::CurveTo(_, _, p) = command {
            (x, y) = (p.x, p.y);
        }
    }
}
