//! What all pictures have in common: axes with their scales, series of points, their marks, and a legend above.

use super::canvas::{Anchor, Canvas, Point, Shape, text_width};
use super::frame::{Frame, Scale, Span, distance};
use super::look::{self, Ink};
use super::svg::label;
use super::thinning::thin;
use super::ticks::Tick;

/// The size of the figures at the ticks and of the names.
pub(crate) const SIZE: f64 = 12.5;

/// How strongly axes and grid lines are drawn.
const AXIS: f64 = 0.55;
const GRID: f64 = 0.13;

/// The longest name that a legend shows in full.
const LONGEST: usize = 28;
/// Height of a line of the legend, length of its samples, room between entries.
const ROW: f64 = 19.0;
const SAMPLE: f64 = 28.0;
const BETWEEN: f64 = 18.0;

/// Room above the frame, for the name of the upright axis, and below it, for the figures and the name of the other.
const ABOVE: f64 = 34.0;
const BELOW: f64 = 44.0;

/// An axis: its name, the range that it shows, and its ticks.
#[derive(Debug)]
pub(crate) struct Axis {
    pub(crate) name: String,
    pub(crate) span: Span,
    pub(crate) scale: Scale,
    pub(crate) ticks: Vec<Tick>,
}

/// An entry of a legend.
pub(crate) type LegendEntry<'a> = (Ink, &'a str);

/// An ink, its opacity, and the width of a line.
pub(crate) type Pen = (Ink, f64, f64);

/// A picture of numbers. What is drawn next belongs to the axes that were drawn last.
#[derive(Debug, Clone, Default)]
pub(crate) struct Figure {
    pub(crate) canvas: Canvas,
    pub(crate) frame: Frame,
    pub(crate) size: [f64; 2],
    /// The name of its files, without their endings.
    pub(crate) file: String,
    /// What it shows, in a few words.
    pub(crate) title: String,
    /// What it shows, in a few sentences.
    pub(crate) caption: String,
}

impl Figure {
    /// One pair of axes below a legend. The names stand at the ends of the axes, where they need no room of their own.
    pub(crate) fn new(
        legend: &[LegendEntry<'_>],
        [width, height]: [f64; 2],
        [left, right]: [f64; 2],
        [x, y]: [Axis; 2],
    ) -> Self {
        let mut figure = Self::default();
        let top = figure.legend(legend, width, 4.0) + ABOVE;
        figure.axes([left, top, width - left - right, height], [&x, &y]);
        let (frame, canvas) = (figure.frame, &mut figure.canvas);
        canvas.text(&x.name, [frame.right(), frame.bottom() + 32.0], Anchor::Right, SIZE);
        canvas.text(&y.name, [left - 8.0, top - 17.0], Anchor::Left, SIZE);
        Self { size: [width, frame.bottom() + BELOW], ..figure }
    }

    pub(crate) fn named(self, file: String, title: String, caption: String) -> Self {
        Self { file, title, caption, ..self }
    }

    /// Axes along a rectangle (left, top, width, height) with their grid, without names.
    pub(crate) fn axes(&mut self, [left, top, width, height]: [f64; 4], [x, y]: [&Axis; 2]) {
        let frame = Frame { left, top, width, height, x: x.span, y: y.span, scales: [x.scale, y.scale] };
        let (right, bottom, canvas) = (frame.right(), frame.bottom(), &mut self.canvas);
        for (value, text) in &x.ticks {
            if let Some([x, _]) = frame.at([*value, frame.y.lo]) {
                canvas.line([[x, top], [x, bottom]], Ink::Text, GRID, 1.0);
                canvas.line([[x, bottom], [x, bottom + 4.0]], Ink::Text, AXIS, 1.0);
                canvas.text(text, [x, bottom + 14.0], Anchor::Middle, SIZE);
            }
        }
        for (value, text) in &y.ticks {
            if let Some([_, y]) = frame.at([frame.x.lo, *value]) {
                canvas.line([[left, y], [right, y]], Ink::Text, GRID, 1.0);
                canvas.line([[left - 4.0, y], [left, y]], Ink::Text, AXIS, 1.0);
                canvas.text(text, [left - 8.0, y], Anchor::Right, SIZE);
            }
        }
        canvas.line([[left, top], [left, bottom], [right, bottom]], Ink::Text, AXIS, 1.2);
        self.frame = frame;
    }

    /// The names along the middles of the axes, as journals have them; the upright one at a distance from its axis.
    pub(crate) fn titles(&mut self, [across, up]: [&str; 2], distance: f64) {
        let Frame { left, top, width, height, .. } = self.frame;
        let below = [left + 0.5 * width, top + height + 31.0];
        self.canvas.text(across, below, Anchor::Middle, SIZE);
        let (at, anchor) = ([left - distance, top + 0.5 * height], Anchor::Middle);
        self.canvas.draw(Shape::Text { text: up.to_owned(), at, anchor, size: SIZE, upright: true }, Ink::Text, 1.0);
    }

    /// The legend of a picture of that width; returns its height.
    pub(crate) fn legend(&mut self, entries: &[LegendEntry<'_>], width: f64, top: f64) -> f64 {
        let [mut along, mut below] = [0.0, 0.0];
        for (ink, name) in entries {
            let name = label(name, LONGEST);
            let room = SAMPLE + 6.0 + text_width(&name, SIZE);
            if along > 0.0 && along + room > width - 20.0 {
                [along, below] = [0.0, below + ROW];
            }
            let [x, y] = [10.0 + along, top + below + 0.5 * ROW];
            let (opacity, width) = if let Ink::Method(k) = *ink { (1.0, look::width(k)) } else { (0.7, 1.3) };
            self.canvas.line([[x, y], [x + SAMPLE, y]], *ink, opacity, width);
            if let Ink::Method(method) = *ink {
                self.canvas.marker(method, [x + 0.5 * SAMPLE, y]);
            }
            self.canvas.text(&name, [x + SAMPLE + 6.0, y], Anchor::Left, SIZE);
            along += room + BETWEEN;
        }
        if entries.is_empty() { 0.0 } else { below + ROW }
    }

    /// Where points lie.
    pub(crate) fn places(&self, points: &[[f64; 2]]) -> Vec<Option<Point>> {
        points.iter().map(|point| self.frame.place(*point)).collect()
    }

    /// Draws the part of a line that the frame shows, thinned to about `most` points if given.
    pub(crate) fn line(&mut self, places: &[Option<Point>], most: Option<usize>, (ink, opacity, width): Pen) {
        let lines = self.frame.lines(places.iter().copied());
        let lines = if let Some(most) = most { thin(lines, most) } else { lines };
        for line in lines {
            self.canvas.line(line, ink, opacity, width);
        }
    }

    /// Draws up to `count` markers along a line, at least `apart` from each other, at places that differ between the `methods` methods.
    pub(crate) fn markers(&mut self, places: &[Option<Point>], method: usize, methods: usize, count: u32, apart: f64) {
        let last = places.len().saturating_sub(1) as f64;
        let mut before: Option<Point> = None;
        for k in 0..count {
            let share = (f64::from(k) + (method as f64 + 0.5) / methods as f64) / f64::from(count);
            let place = places.get((share * last).round() as usize).copied().flatten();
            if let Some(place) = place.filter(|place| self.frame.holds(*place))
                && before.is_none_or(|before| distance(before, place) > apart)
            {
                self.canvas.marker(method, place);
                before = Some(place);
            }
        }
    }
}
