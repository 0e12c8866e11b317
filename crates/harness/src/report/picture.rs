//! A picture, and the two forms in which it appears: in the page, and as a file.

use super::ReportError;
use super::canvas::{Canvas, Drawn, shapes, units};
use super::xml::escape;

/// How near a pointer must come to a point.
const TIP: f64 = 6.0;

/// A finished picture.
#[derive(Debug)]
pub(super) struct Picture {
    /// The name of its file.
    pub(super) file: String,
    /// What it shows, in a few words.
    pub(super) title: String,
    /// What it shows, in a few sentences.
    pub(super) caption: String,
    size: [f64; 2],
    shapes: String,
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
            Ok(shapes) => Ok(Self { file, title, caption, size, shapes }),
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
        format!("<svg{} role=\"img\" aria-label=\"{}\">{}</svg>", self.frame(), escape(&self.title), self.shapes)
    }

    /// The picture as a file: on a ground of its own, white or dark as the reader prefers, white where that is unknown.
    pub(super) fn standalone(&self) -> String {
        format!(
            "<svg{} width=\"{:.0}\" height=\"{:.0}\" color=\"#1d2329\">\n<title>{}</title>\n<style>\
             @media (prefers-color-scheme: dark) {{ svg {{ color: #dfe4e8 }} .ground {{ fill: #14181c }} }}</style>\n\
             <rect class=\"ground\" width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>{}</svg>\n",
            self.frame(),
            self.size[0],
            self.size[1],
            escape(&self.title),
            self.shapes,
        )
    }

    fn frame(&self) -> String {
        let [width, height] = self.size.map(units);
        format!(" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" stroke-linejoin=\"round\"")
    }
}
