//! The forms in which a figure appears: in the page, and as files.

use super::ReportError;
use super::figure::Figure;
use super::look::TEXT;
use super::pdf::pdf;
use super::raster::png;
use super::svg::{escape, shapes, units};

/// Units of a picture in an inch, as in CSS: text of 12.5 units has 9.4 points.
pub(crate) const UNITS_PER_INCH: f64 = 96.0;
/// Pixels to a unit in the PNG files of pages: sharp on a fine screen.
const PAGE_SCALE: f64 = 2.0;

/// The format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFormat {
    /// Scalable Vector Graphics.
    Svg,
    /// Portable Network Graphics, with its resolution.
    Png,
    /// Portable Document Format, one page.
    Pdf,
}

impl Figure {
    /// The picture as a part of a page, transparent, in the page's text colour, with more elements above everything else.
    pub(crate) fn inline(&self, inside: &str) -> String {
        let (frame, title) = (self.frame(), escape(&self.title));
        format!("<svg{frame} role=\"img\" aria-label=\"{title}\">\n{}{inside}</svg>", shapes(&self.canvas.marks))
    }

    /// The files of the picture: SVG, and PNG for whatever shows no SVG.
    pub(crate) fn files(&self) -> Result<[(String, Vec<u8>); 2], ReportError> {
        let png = png(self.size, &self.canvas.marks, PAGE_SCALE, PAGE_SCALE * UNITS_PER_INCH)?;
        Ok([(format!("{}.svg", self.file), self.svg(1.0).into_bytes()), (format!("{}.png", self.file), png)])
    }

    /// The bytes of a file of this format, with `dpi` pixels to an inch. The picture is scaled by `scale`.
    pub(crate) fn bytes(&self, format: FigureFormat, dpi: f64, scale: f64) -> Result<Vec<u8>, ReportError> {
        let marks = &self.canvas.marks;
        match format {
            FigureFormat::Svg => Ok(self.svg(scale).into_bytes()),
            FigureFormat::Png => png(self.size, marks, scale * dpi / UNITS_PER_INCH, dpi),
            FigureFormat::Pdf => pdf(self.size, &self.title, marks, scale),
        }
    }

    /// The text of an SVG file, on a light ground of its own.
    pub(crate) fn svg(&self, scale: f64) -> String {
        let [width, height] = self.size.map(|length| scale * length);
        format!(
            "<svg{} width=\"{width:.0}\" height=\"{height:.0}\" color=\"{TEXT}\">\n<title>{}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.frame(),
            escape(&self.title),
            shapes(&self.canvas.marks),
        )
    }

    fn frame(&self) -> String {
        let [width, height] = self.size.map(units);
        format!(" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" stroke-linejoin=\"round\"")
    }
}
