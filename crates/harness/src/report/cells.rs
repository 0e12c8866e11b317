//! Values over a grid as coloured cells, with a bar that tells what the colours mean.

use super::axis::{self, SIZE};
use super::canvas::{Anchor, Canvas, Drawn, Ink, units};
use super::geometry::{PlotFrame, Span};

/// The map viridis: its lightness grows evenly, so that any eye, and a grey print, can order its colours.
const COLOURS: [&str; 16] = [
    "#440154", "#481a6c", "#472f7d", "#414487", "#39568c", "#31688e", "#2a788e", "#23888e", "#1f988b", "#22a884",
    "#35b779", "#54c568", "#7ad151", "#a5db36", "#d2e21b", "#fde725",
];
const BAR: f64 = 14.0;

/// Values over a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// What the colours show, with its unit.
    pub label: String,
    /// The ends of the range across and upwards.
    pub ranges: [[f64; 2]; 2],
    /// The number of columns.
    pub columns: usize,
    /// The values row by row from the lowest row on, each from the left; a cell without one stays empty.
    pub values: Vec<Option<f64>>,
}

impl Cells {
    /// The range of the colours; it begins at zero where nothing is below.
    fn span(&self) -> Span {
        let span = Span::of(self.values.iter().flatten().copied()).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        let lo = span.lo.min(0.0);
        Span { lo, hi: if span.hi > lo { span.hi } else { lo + 1.0 } }
    }

    fn rows(&self) -> usize {
        self.values.len() / self.columns.max(1)
    }

    /// One path for each colour.
    pub(super) fn shapes(&self, frame: &PlotFrame) -> String {
        let span = self.span();
        let edge = |axis: usize, k: usize, count: usize| {
            let [lo, hi] = self.ranges[axis];
            lo + (hi - lo) * k as f64 / count.max(1) as f64
        };
        let mut paths = vec![String::new(); COLOURS.len()];
        for (place, value) in self.values.iter().enumerate() {
            let Some(value) = value.filter(|value| value.is_finite()) else { continue };
            let (row, column) = (place / self.columns.max(1), place % self.columns.max(1));
            let corner = |i, j| frame.place([edge(0, column + i, self.columns), edge(1, row + j, self.rows())]);
            let (Some(low), Some(high)) = (corner(0, 0), corner(1, 1)) else { continue };
            let [x, y, right, top] = [low[0], low[1], high[0], high[1]].map(units);
            let shade = (value - span.lo) / (span.hi - span.lo) * COLOURS.len() as f64;
            paths[(shade as usize).min(COLOURS.len() - 1)] += &format!("M{x} {y}V{top}H{right}V{y}z");
        }
        let colours = COLOURS.iter().zip(paths).filter(|(_, path)| !path.is_empty());
        colours
            .map(|(colour, path)| format!("<path fill=\"{colour}\" shape-rendering=\"crispEdges\" d=\"{path}\"/>\n"))
            .collect()
    }

    /// The colours of the bar, beside the frame.
    pub(super) fn bar(&self, frame: &PlotFrame) -> String {
        let height = frame.height / COLOURS.len() as f64;
        let cell = |(k, colour): (usize, &&str)| {
            let top = frame.bottom() - height * (k + 1) as f64;
            let [x, y, width, height] = [frame.right() + 16.0, top, BAR, height].map(units);
            format!("<rect fill=\"{colour}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{}\"/>\n", height + 1)
        };
        COLOURS.iter().enumerate().map(cell).collect()
    }

    /// The figures of the bar.
    pub(super) fn figures(&self, canvas: &Canvas<'_>, frame: &PlotFrame) -> Drawn {
        let span = self.span();
        let x = frame.right() + 16.0 + BAR;
        for (value, text) in axis::linear(span, 6.0) {
            let y = frame.bottom() - (value - span.lo) / (span.hi - span.lo) * frame.height;
            canvas.line(&[[x, y], [x + 4.0, y]], Ink::Text, 0.55, 1.0)?;
            canvas.text(&text, [x + 8.0, y], Anchor::Left, SIZE)?;
        }
        canvas.text(&self.label, [x + 44.0, frame.top - 17.0], Anchor::Right, SIZE)
    }
}
