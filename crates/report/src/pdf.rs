//! Marks as a PDF file of one page: lines and outlines, which a printer draws as finely as it can.

use super::ReportError;
use super::canvas::{Mark, Shape};
use super::outlines::Outliner;
use super::raster::LEVEL;
use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use zeno::Command;

/// Points of 1/72 inch to a unit of the picture, of which an inch has 96.
const POINTS: f64 = 0.75;

/// The bytes of a PDF file with the picture scaled by `scale`.
pub(crate) fn pdf(size: [f64; 2], title: &str, marks: &[Mark], scale: f64) -> Result<Vec<u8>, ReportError> {
    let outliner = Outliner::new(1.0)?;
    let mut content = Content::new();
    // Upwards in a PDF is downwards in a picture.
    let points = POINTS * scale;
    content.transform([points, 0.0, 0.0, -points, 0.0, points * size[1]].map(|x| x as f32));
    for Mark { shape, ink, opacity } in marks {
        // What an ink looks like on a white ground.
        let [red, green, blue] = ink.rgb().map(|part| (1.0 - opacity * (1.0 - f64::from(part) / 255.0)) as f32);
        if let Shape::Line { width, .. } = shape {
            content.set_stroke_rgb(red, green, blue).set_line_width(*width as f32);
            content.set_dash_pattern(ink.dashes().iter().map(|length| *length as f32), 0.0);
            written(&mut content, &outliner.path(shape));
            content.stroke();
        } else {
            content.set_fill_rgb(red, green, blue);
            written(&mut content, &outliner.path(shape));
            content.fill_nonzero();
        }
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

/// A path; a PDF has no curves of second degree.
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
