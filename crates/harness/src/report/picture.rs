//! A picture, and the forms in which it appears: in the page, and as files.

use super::ReportError;
use super::canvas::{Canvas, CanvasMark, Drawn, shapes, units};
use super::xml::escape;
use super::{look, pdf, raster};

/// Units of a picture in an inch, as in CSS: text of 12.5 units has 9.4 points.
pub(super) const UNITS_PER_INCH: f64 = 96.0;

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

/// Pixels to a unit in the PNG files of pages: sharp on a fine screen.
const PAGE_SCALE: f64 = 2.0;
/// How near a pointer must come to a point.
const TIP: f64 = 6.0;

/// A finished picture.
#[derive(Debug)]
pub(super) struct Picture {
    /// The name of its files, without their endings.
    pub(super) file: String,
    /// What it shows, in a few words.
    pub(super) title: String,
    /// What it shows, in a few sentences.
    pub(super) caption: String,
    size: [f64; 2],
    shapes: String,
    marks: Vec<CanvasMark>,
}

impl Picture {
    /// Draws a picture.
    pub(super) fn draw(
        file: String,
        title: String,
        caption: String,
        size: [f64; 2],
        draw: impl FnOnce(&Canvas<'_>) -> Drawn,
    ) -> Result<Self, ReportError> {
        match shapes(size, draw) {
            Ok((shapes, marks)) => Ok(Self { file, title, caption, size, shapes, marks }),
            Err(error) => Err(ReportError::Draw { picture: file, reason: error.to_string() }),
        }
    }

    /// Adds what a pointer is told over some points.
    pub(super) fn told(mut self, tips: &[([f64; 2], String)]) -> Self {
        for ([x, y], text) in tips {
            let [x, y, r] = [*x, *y, TIP].map(units);
            self.shapes += &format!(
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"none\" pointer-events=\"all\"><title>{}</title></circle>\n",
                escape(text)
            );
        }
        self
    }

    /// Adds shapes on top, in units of the canvas.
    pub(super) fn with(mut self, shapes: &str) -> Self {
        self.shapes += shapes;
        self
    }

    /// The picture as a part of a page: transparent, in the page's text colour.
    pub(super) fn inline(&self) -> String {
        self.with_inside("")
    }

    /// The same with more inside, above everything else.
    pub(super) fn with_inside(&self, inside: &str) -> String {
        let (frame, title) = (self.frame(), escape(&self.title));
        format!("<svg{frame} role=\"img\" aria-label=\"{title}\">{}{inside}</svg>", self.shapes)
    }

    /// The files of the picture: SVG, and PNG for whatever shows no SVG.
    pub(super) fn files(&self) -> Result<[(String, Vec<u8>); 2], ReportError> {
        let failed = |reason| ReportError::Draw { picture: format!("{}.png", self.file), reason };
        let png = raster::png(self.size, &self.marks, PAGE_SCALE, PAGE_SCALE * UNITS_PER_INCH).map_err(failed)?;
        Ok([(format!("{}.svg", self.file), self.standalone().into_bytes()), (format!("{}.png", self.file), png)])
    }

    /// The picture as the bytes of a file of that format, with so many pixels to an inch, `scale` times as large as it was drawn.
    pub(super) fn bytes(&self, format: FigureFormat, dpi: f64, scale: f64) -> Result<Vec<u8>, ReportError> {
        let drawn = match format {
            FigureFormat::Svg => Ok(self.scaled(scale).into_bytes()),
            FigureFormat::Png => raster::png(self.size, &self.marks, scale * dpi / UNITS_PER_INCH, dpi),
            FigureFormat::Pdf => pdf::file(self.size, &self.title, &self.marks, scale),
        };
        drawn.map_err(|reason| ReportError::Draw { picture: self.file.clone(), reason })
    }

    /// The picture as a file: on a light ground of its own.
    pub(super) fn standalone(&self) -> String {
        self.scaled(1.0)
    }

    /// The same, so many times as large as it was drawn.
    fn scaled(&self, scale: f64) -> String {
        format!(
            "<svg{} width=\"{:.0}\" height=\"{:.0}\" color=\"{TEXT}\">\n<title>{}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>{}</svg>\n",
            self.frame(),
            scale * self.size[0],
            scale * self.size[1],
            escape(&self.title),
            self.shapes,
            TEXT = look::TEXT,
        )
    }

    fn frame(&self) -> String {
        let [width, height] = self.size.map(units);
        format!(" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" stroke-linejoin=\"round\"")
    }
}
