//! Parsers of argument values, with their error messages.

use clap::builder::{OsStringValueParser, TypedValueParser};
use std::str::FromStr;

/// Width and height (cm).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Size(pub(crate) [f64; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let units = [("cm", 1.0), ("mm", 0.1), ("in", 2.54)];
        let found = units.iter().find_map(|(unit, length)| Some((text.trim().strip_suffix(unit)?, length)));
        let sides = found.and_then(|(sides, unit)| Some((sides.split_once('x')?, unit)));
        let length = |side: &str, unit: f64| side.trim().parse::<f64>().ok().map(|side| side * unit);
        let size = sides.and_then(|((width, height), unit)| Some([length(width, *unit)?, length(height, *unit)?]));
        let fits = |size: &[f64; 2]| size.iter().all(|side| (3.0..=200.0).contains(side));
        size.filter(fits).map(Self).ok_or_else(|| {
            "accepted are a width and a height, for example 16x9cm, 160x90mm or 6.3x3.5in, each from \
                3 to 200 cm"
                .to_owned()
        })
    }
}

pub(super) fn dpi(text: &str) -> Result<u32, &'static str> {
    let dpi = text.trim().parse().ok().filter(|dpi| (30..=1200).contains(dpi));
    dpi.ok_or("accepted is a whole number from 30 to 1200")
}

pub(super) fn count(text: &str) -> Result<u64, &'static str> {
    let count = text.trim().parse().ok().filter(|count| *count > 0);
    count.ok_or("accepted is a whole number of 1 or more")
}

/// Maximum of `--event-samples`: parts of a step in which events are searched. Each part costs a step of the method.
const MOST_SAMPLES: u32 = 10_000;

pub(super) fn event_samples(text: &str) -> Result<u32, String> {
    let samples = text.trim().parse().ok().filter(|samples| (1..=MOST_SAMPLES).contains(samples));
    samples.ok_or_else(|| format!("accepted is a whole number from 1 to {MOST_SAMPLES}"))
}

pub(super) fn number(text: &str) -> Result<f64, &'static str> {
    text.trim().parse().map_err(|_| "not a number; accepted are numbers like 0.05 and 1e-3")
}

pub(super) fn not_negative(text: &str) -> Result<f64, &'static str> {
    let number = number(text).ok().filter(|number| *number >= 0.0 && number.is_finite());
    number.ok_or("accepted is a number of 0 or more")
}

/// A day, in s.
const DAY: f64 = 86400.0;

pub(super) fn at_most_a_day(text: &str) -> Result<f64, &'static str> {
    let seconds = number(text).ok().filter(|number| *number > 0.0 && *number <= DAY);
    seconds.ok_or("accepted is a number greater than 0 and at most 86400")
}

/// The path of a scene, in whatever bytes.
pub(super) fn scene_path() -> impl TypedValueParser<Value = String> {
    OsStringValueParser::new().map(|path| scene::name_of_path(&path))
}
