//! Axes: where the ticks are, what they say, and the legend above.

use super::canvas::{Anchor, Canvas, Drawn, Ink, text_width};
use super::geometry::{PlotFrame, Span};
use super::xml::label;

/// The size of the figures at the ticks and of the names.
pub(super) const SIZE: f64 = 12.5;

/// How strongly axes and grid lines are drawn.
const AXIS: f64 = 0.55;
const GRID: f64 = 0.13;

/// The longest name that a legend shows in full.
pub(super) const LONGEST: usize = 28;

/// A tick: where it is and what it says.
pub(super) type Tick = (f64, String);

/// About `wanted` ticks at round numbers.
pub(super) fn linear(span: Span, wanted: f64) -> Vec<Tick> {
    let rough = (span.hi - span.lo) / wanted.max(1.0);
    let power = 10.0_f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= 0.999 * rough).unwrap_or(10.0);
    let step = factor * power;
    let first = (span.lo / step - 1e-6).ceil();
    let last = (span.hi / step + 1e-6).floor();
    let largest = span.lo.abs().max(span.hi.abs());
    // The count is bounded whatever rounding does to the numbers above.
    (0..40)
        .map(|k| first + f64::from(k))
        .take_while(|multiple| *multiple <= last)
        .map(|multiple| (multiple * step, number(multiple * step, step, largest)))
        .collect()
}

/// Ticks at whole decades, of their logarithms, about so many at most.
pub(super) fn decades(span: Span, most: f64) -> Vec<Tick> {
    let rough = (span.hi - span.lo) / most;
    let every = [1.0, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0, 50.0].into_iter().find(|every| *every >= rough).unwrap_or(100.0);
    let first = (span.lo / every).ceil();
    let decades = (0..40).map(|k| (first + f64::from(k)) * every).take_while(|decade| *decade <= span.hi);
    decades.map(|decade| (decade, format!("10{}", superscript(&format!("{decade:.0}"))))).collect()
}

/// A number with the digits that tell it from its neighbours `step` away, on an axis that reaches to `largest`.
fn number(value: f64, step: f64, largest: f64) -> String {
    let text = if value.abs() < 1e-6 * step {
        "0".to_owned()
    } else if largest >= 1e5 || step < 1e-4 {
        let exponent = value.abs().log10().floor();
        let digits = (exponent - step.log10().floor()).clamp(0.0, 12.0) as usize;
        let text = format!("{value:.digits$e}");
        match text.split_once('e') {
            Some((mantissa, exponent)) => format!("{mantissa}×10{}", superscript(exponent)),
            None => text,
        }
    } else {
        let digits = (-(step * 1.001).log10().floor()).clamp(0.0, 12.0) as usize;
        format!("{value:.digits$}")
    };
    text.replace('-', "−")
}

/// A whole number in superscript digits.
pub(super) fn superscript(number: &str) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        c => c,
    };
    number.chars().map(raised).collect()
}

/// The room that the figures of the upright axis need, with what separates them from it.
pub(super) fn margin(ticks: &[Tick]) -> f64 {
    ticks.iter().map(|(_, text)| text_width(text, SIZE)).fold(20.0, f64::max) + 14.0
}

/// The axes of a frame with their grid; the names stand at the ends, where they need no room of their own.
pub(super) fn draw(canvas: &Canvas<'_>, frame: &PlotFrame, ticks: [&[Tick]; 2], names: [&str; 2]) -> Drawn {
    bare(canvas, frame, ticks)?;
    canvas.text(names[0], [frame.right(), frame.bottom() + 32.0], Anchor::Right, SIZE)?;
    canvas.text(names[1], [frame.left - 8.0, frame.top - 17.0], Anchor::Left, SIZE)
}

/// The same with the names along the middles of the axes, as journals have them; the upright one at a distance from its axis.
pub(super) fn titled(
    canvas: &Canvas<'_>,
    frame: &PlotFrame,
    ticks: [&[Tick]; 2],
    names: [&str; 2],
    distance: f64,
) -> Drawn {
    bare(canvas, frame, ticks)?;
    canvas.text(names[0], [frame.left + 0.5 * frame.width, frame.bottom() + 31.0], Anchor::Middle, SIZE)?;
    canvas.upright_text(names[1], [frame.left - distance, frame.top + 0.5 * frame.height], SIZE)
}

/// The axes of a frame with their grid, without names.
fn bare(canvas: &Canvas<'_>, frame: &PlotFrame, ticks: [&[Tick]; 2]) -> Drawn {
    let (left, right, top, bottom) = (frame.left, frame.right(), frame.top, frame.bottom());
    let [across, up] = ticks;
    for (value, text) in across {
        if let Some([x, _]) = frame.place([*value, frame.y.lo]) {
            canvas.line(&[[x, top], [x, bottom]], Ink::Text, GRID, 1.0)?;
            canvas.line(&[[x, bottom], [x, bottom + 4.0]], Ink::Text, AXIS, 1.0)?;
            canvas.text(text, [x, bottom + 14.0], Anchor::Middle, SIZE)?;
        }
    }
    for (value, text) in up {
        if let Some([_, y]) = frame.place([frame.x.lo, *value]) {
            canvas.line(&[[left, y], [right, y]], Ink::Text, GRID, 1.0)?;
            canvas.line(&[[left - 4.0, y], [left, y]], Ink::Text, AXIS, 1.0)?;
            canvas.text(text, [left - 8.0, y], Anchor::Right, SIZE)?;
        }
    }
    canvas.line(&[[left, top], [left, bottom], [right, bottom]], Ink::Text, AXIS, 1.2)
}

/// An entry of a legend.
pub(super) type LegendEntry<'a> = (Ink, &'a str);

/// Height of a line of the legend, length of its samples, room between entries.
const ROW: f64 = 19.0;
const SAMPLE: f64 = 28.0;
const BETWEEN: f64 = 18.0;

/// Where the entries of a legend go, relative to its corner, and how high it is.
pub(super) fn legend(entries: &[LegendEntry<'_>], width: f64) -> (Vec<[f64; 2]>, f64) {
    let mut corner = [0.0, 0.0];
    let mut places = Vec::with_capacity(entries.len());
    for (_, name) in entries {
        let room = SAMPLE + 6.0 + text_width(&label(name, LONGEST), SIZE);
        if corner[0] > 0.0 && corner[0] + room > width {
            corner = [0.0, corner[1] + ROW];
        }
        places.push(corner);
        corner[0] += room + BETWEEN;
    }
    (places, if entries.is_empty() { 0.0 } else { corner[1] + ROW })
}

/// Draws a legend with its upper left corner at a point.
pub(super) fn draw_legend(
    canvas: &Canvas<'_>,
    entries: &[LegendEntry<'_>],
    places: &[[f64; 2]],
    at: [f64; 2],
) -> Drawn {
    for ((ink, name), place) in entries.iter().zip(places) {
        let [x, y] = [at[0] + place[0], at[1] + place[1] + 0.5 * ROW];
        if let Ink::Method(method) = *ink {
            canvas.line(&[[x, y], [x + SAMPLE, y]], *ink, 1.0, super::look::width(method))?;
            canvas.marker(method, [x + 0.5 * SAMPLE, y])?;
        } else {
            canvas.line(&[[x, y], [x + SAMPLE, y]], *ink, 0.7, 1.3)?;
        }
        canvas.text(&label(name, LONGEST), [x + SAMPLE + 6.0, y], Anchor::Left, SIZE)?;
    }
    Ok(())
}
