//! Curves in a plane of two quantities, on linear axes: phase portraits, maps of a circle.

use super::ReportError;
use super::axis;
use super::canvas::Ink;
use super::geometry::{Frame, Span};
use super::look;
use super::path::thinned;
use super::picture::Picture;

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 380.0;
/// How much of a range stays free at each of its ends.
const MARGIN: f64 = 0.05;

/// A picture of curves in a plane.
#[derive(Debug, Clone)]
pub struct Plane {
    /// What it shows, in a few words.
    pub title: String,
    /// The names of the axes with their units.
    pub axes: [String; 2],
    /// The curves, by kinds: each kind has a name and a look.
    pub kinds: Vec<Curves>,
}

/// Curves of one kind.
#[derive(Debug, Clone)]
pub struct Curves {
    /// The name.
    pub label: String,
    /// The points of each curve; a curve of one point is drawn as a marker.
    pub curves: Vec<Vec<[f64; 2]>>,
}

/// The picture as the text of an SVG file.
///
/// # Errors
/// [`ReportError::Draw`] if the drawing library fails.
pub fn plane(plane: &Plane) -> Result<String, ReportError> {
    let entries: Vec<axis::Entry<'_>> =
        plane.kinds.iter().enumerate().map(|(kind, curves)| (Ink::Method(kind), curves.label.as_str())).collect();
    let (places, legend) = axis::legend(&entries, WIDTH - 20.0);
    let [x, y] = [0, 1].map(|axis| {
        let points = plane.kinds.iter().flat_map(|kind| kind.curves.iter().flatten());
        let span = Span::of(points.map(|point| point[axis])).unwrap_or(Span { lo: -1.0, hi: 1.0 });
        let half = super::geometry::visible(span.half(), span.lo.abs().max(span.hi.abs()));
        Span::about(span.middle(), (1.0 + 2.0 * MARGIN) * half)
    });
    let (across, up) = (axis::linear(x, 7.0), axis::linear(y, 6.0));
    let left = axis::margin(&up);
    let frame = Frame { left, top: legend + 34.0, width: WIDTH - left - 24.0, height: HEIGHT, x, y };
    let [horizontal, vertical] = plane.axes.each_ref().map(String::as_str);
    let size = [WIDTH, frame.bottom() + 44.0];
    let picture = Picture::draw(String::new(), plane.title.clone(), String::new(), size, |canvas| {
        axis::draw_legend(canvas, &entries, &places, [10.0, 4.0])?;
        axis::draw(canvas, &frame, [&across, &up], [horizontal, vertical])?;
        for (kind, curves) in plane.kinds.iter().enumerate() {
            for curve in &curves.curves {
                if let [point] = curve.as_slice() {
                    frame.place(*point).map_or(Ok(()), |place| canvas.marker(kind, place))?;
                }
                for line in thinned(&frame, curve) {
                    canvas.line(&line, Ink::Method(kind), 0.9, look::width(1))?;
                }
            }
        }
        Ok(())
    })?;
    Ok(picture.standalone())
}
