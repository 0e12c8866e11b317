//! Where the ticks of an axis are, and what they say.

use super::canvas::text_width;
use super::figure::SIZE;
use super::frame::Span;

/// A tick: its place on the axis and its label.
pub(crate) type Tick = (f64, String);

/// About `wanted` ticks at round numbers.
pub(crate) fn linear(span: Span, wanted: f64) -> Vec<Tick> {
    let rough = (span.hi - span.lo) / wanted.max(1.0);
    let power = 10.0_f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= 0.999 * rough).unwrap_or(10.0);
    let step = factor * power;
    let largest = span.lo.abs().max(span.hi.abs());
    let multiples = multiples([span.lo / step - 1e-6, span.hi / step + 1e-6]);
    multiples.map(|multiple| (multiple * step, number(multiple * step, step, largest))).collect()
}

/// At most `most` ticks at round numbers, so few that their labels do not overlap on an axis of this width.
pub(crate) fn across(span: Span, width: f64, most: f64) -> Vec<Tick> {
    linear(span, (width / (1.4 * margin(&linear(span, 6.0)))).clamp(2.0, most))
}

/// Ticks at whole decades, about `most` at most, for a `span` in decades. No tick lies within `free` tick distances of the lower end.
pub(crate) fn decades(span: Span, most: f64, free: f64) -> Vec<Tick> {
    let rough = (span.hi - span.lo) / most;
    let every = [1.0, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0, 50.0].into_iter().find(|every| *every >= rough).unwrap_or(100.0);
    let multiples = multiples([(span.lo + free * every) / every, span.hi / every]);
    multiples.map(|multiple| (multiple * every, power(multiple * every))).collect()
}

/// Whole decades that hold a range.
pub(crate) fn whole_decades(Span { lo, hi }: Span, beyond: f64) -> Span {
    let lo = (lo - beyond).floor();
    Span { lo, hi: (hi + beyond).ceil().max(lo + 1.0) }
}

/// The whole numbers between two; their count is bounded whatever rounding does to the numbers before.
fn multiples([lo, hi]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..40).map(move |k| lo.ceil() + f64::from(k)).take_while(move |multiple| *multiple <= hi)
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

/// Ten to a power.
pub(crate) fn power(decade: f64) -> String {
    format!("10{}", superscript(&format!("{decade:.0}")))
}

/// A whole number in superscript digits.
fn superscript(number: &str) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or(if c == '-' { '⁻' } else { c }, |digit| digits[digit as usize]);
    number.chars().map(raised).collect()
}

/// The room that the figures of the upright axis need, with what separates them from it.
pub(crate) fn margin(ticks: &[Tick]) -> f64 {
    ticks.iter().map(|(_, text)| text_width(text, SIZE)).fold(20.0, f64::max) + 14.0
}
