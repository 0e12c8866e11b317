//! What pictures are drawn on: a thin layer over the SVG backend of plotters, which notes what was drawn, for the raster.
//!
//! The backend places everything on whole units, so the canvas has [`SCALE`] of them to a unit of the picture. It also
//! knows neither dashes nor the colour of the surrounding text: shapes are drawn in stand-in colours, which
//! [`recolour`] turns into the attributes that are meant.

use super::look;
use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, IntoDrawingArea, IntoFont, PathElement, Polygon, SVGBackend, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, ShapeStyle, TextStyle};
use std::cell::RefCell;
use std::io;

/// What drawing returns.
pub(super) type Drawn<T = ()> = Result<T, plotters::drawing::DrawingAreaErrorKind<io::Error>>;

/// Units of the canvas to a unit of the picture.
const SCALE: f64 = 10.0;

/// The stand-in for the text colour of whatever surrounds the picture.
const TEXT: RGBColor = RGBColor(0, 0, 0);
/// The stand-in for the same colour, dashed.
const DASHED: RGBColor = RGBColor(0, 0, 1);

/// What to draw with.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ink {
    /// The colour of text.
    Text,
    /// The colour of text, thin dashes: what is known without computing.
    Exact,
    /// The look of a method.
    Method(usize),
}

impl Ink {
    fn stand_in(self) -> RGBColor {
        match self {
            Self::Text => TEXT,
            Self::Exact => DASHED,
            // Fewer looks than a byte has values: nothing is cut off.
            Self::Method(method) => RGBColor(1, 0, (method % look::LOOKS) as u8),
        }
    }
}

/// Where text stands relative to its point.
#[derive(Debug, Clone, Copy)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
}

/// Something drawn. All lengths are in units of the picture, from its upper left corner.
#[derive(Debug, Clone)]
pub(super) enum CanvasMark {
    Line {
        points: Vec<[f64; 2]>,
        ink: Ink,
        opacity: f64,
        width: f64,
    },
    Area {
        points: Vec<[f64; 2]>,
        ink: Ink,
        opacity: f64,
    },
    /// Upright: read from below to above.
    Text {
        text: String,
        at: [f64; 2],
        anchor: Anchor,
        size: f64,
        upright: bool,
    },
}

/// What a picture is drawn on.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
    marks: &'a RefCell<Vec<CanvasMark>>,
}

impl Canvas<'_> {
    pub(super) fn line(&self, points: &[[f64; 2]], ink: Ink, opacity: f64, width: f64) -> Drawn {
        self.marks.borrow_mut().push(CanvasMark::Line { points: points.to_vec(), ink, opacity, width });
        let style = ShapeStyle::from(ink.stand_in().mix(opacity)).stroke_width(units(width).unsigned_abs());
        self.area.draw(&PathElement::new(points.iter().map(corner).collect::<Vec<_>>(), style))
    }

    pub(super) fn fill(&self, points: &[[f64; 2]], ink: Ink, opacity: f64) -> Drawn {
        self.marks.borrow_mut().push(CanvasMark::Area { points: points.to_vec(), ink, opacity });
        let style = ShapeStyle::from(ink.stand_in().mix(opacity)).filled();
        self.area.draw(&Polygon::new(points.iter().map(corner).collect::<Vec<_>>(), style))
    }

    /// The marker of a method at a point.
    pub(super) fn marker(&self, method: usize, [x, y]: [f64; 2]) -> Drawn {
        let outline: Vec<[f64; 2]> = look::marker(method).iter().map(|[dx, dy]| [x + dx, y + dy]).collect();
        self.fill(&outline, Ink::Method(method), 1.0)
    }

    /// The mark at a point where the line of a method stops because its run failed.
    pub(super) fn cross(&self, method: usize, [x, y]: [f64; 2]) -> Drawn {
        let outline: Vec<[f64; 2]> = look::cross().iter().map(|[dx, dy]| [x + dx, y + dy]).collect();
        self.fill(&outline, Ink::Method(method), 1.0)
    }

    /// A line of text whose middle height is that of the point.
    pub(super) fn text(&self, text: &str, at: [f64; 2], anchor: Anchor, size: f64) -> Drawn {
        self.write(text, at, anchor, size, false)
    }

    /// The same from below to above, with its middle at the point.
    pub(super) fn upright_text(&self, text: &str, at: [f64; 2], size: f64) -> Drawn {
        self.write(text, at, Anchor::Middle, size, true)
    }

    fn write(&self, text: &str, at: [f64; 2], anchor: Anchor, size: f64, upright: bool) -> Drawn {
        self.marks.borrow_mut().push(CanvasMark::Text { text: text.to_owned(), at, anchor, size, upright });
        let across = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        // The backend divides by this number what it is given.
        let font = ("sans-serif", 1.24 * size * SCALE).into_font();
        let font = if upright { font.transform(FontTransform::Rotate270) } else { font };
        let style = TextStyle::from(font).color(&TEXT).pos(Pos::new(across, VPos::Center));
        self.area.draw(&Text::new(text, corner(&at), style))
    }
}

/// About how wide a text is, its font being whichever the reader has.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    text.chars()
        .map(|c| if matches!(c, '⁰'..='⁹' | '⁻' | '¹' | '²' | '³' | '.' | 'i' | 'l') { 0.38 } else { 0.58 })
        .sum::<f64>()
        * size
}

fn corner(&[x, y]: &[f64; 2]) -> (i32, i32) {
    (units(x), units(y))
}

/// A length in units of the canvas; conversion saturates, and every caller stays within the frame.
pub(super) fn units(length: f64) -> i32 {
    (length * SCALE).round() as i32
}

/// What the backend draws, without the `svg` element around it, and the same as marks.
pub(super) fn shapes(size: [f64; 2], draw: impl FnOnce(&Canvas<'_>) -> Drawn) -> Drawn<(String, Vec<CanvasMark>)> {
    let mut document = String::new();
    let marks = RefCell::new(Vec::new());
    let [width, height] = size.map(|length| units(length).unsigned_abs());
    {
        let area = SVGBackend::with_string(&mut document, (width, height)).into_drawing_area();
        let canvas = Canvas { area, marks: &marks };
        draw(&canvas)?;
        canvas.area.present()?;
    }
    let inner = document.split_once('>').map_or("", |(_, inner)| inner);
    let inner = inner.rsplit_once("</svg>").map_or(inner, |(inner, _)| inner);
    Ok((recolour(inner), marks.into_inner()))
}

/// Replaces the stand-in colours, and says of each shape which run it belongs to. Text cannot be mistaken for an attribute: its quotes are escaped.
fn recolour(shapes: &str) -> String {
    let mut shapes = shapes.replace("\"#000000\"", "\"currentColor\"");
    let exact = look::written(&look::EXACT, SCALE);
    let dashed = format!("stroke=\"currentColor\" stroke-dasharray=\"{exact}\"");
    shapes = shapes.replace("stroke=\"#000001\"", &dashed);
    for method in 0..look::LOOKS {
        let stand_in = format!("=\"#0100{method:02X}\"");
        if shapes.contains(&stand_in) {
            let (colour, dashes) = (look::colour(method), look::written(look::dashes(method), SCALE));
            let stroke = format!("data-run=\"{method}\" stroke=\"{colour}\" stroke-dasharray=\"{dashes}\"");
            let stroke = stroke.replace(" stroke-dasharray=\"\"", "");
            shapes = shapes.replace(&format!("stroke{stand_in}"), &stroke);
            shapes = shapes.replace(&format!("fill{stand_in}"), &format!("data-run=\"{method}\" fill=\"{colour}\""));
        }
    }
    // Half the height of a digit, rather than of an x, puts the digits of a tick onto its height.
    shapes.replace("dy=\"0.5ex\"", "dy=\"0.36em\"").replace(" opacity=\"1\"", "")
}
