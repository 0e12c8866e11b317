//! Verdicts on constraint and energy from a row of `compare --json`.

use serde_json::Value;

/// The course of the energy error; its size in J, and its slope in J/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Energy {
    Rounding,
    Swings(f64),
    Drifts(f64),
    Wanders(f64),
    /// Not clear: in a run of that length (s) a drift of the slope found would show.
    Open(Option<f64>),
}

impl Energy {
    /// The verdict from a row of `compare --json`.
    pub(crate) fn of(row: &Value) -> Self {
        let number = |key: &str| row["energy"][key].as_f64();
        let most = number("max_error").unwrap_or(f64::NAN);
        if most <= rounding(row) * number("initial").unwrap_or(0.0).abs().max(1.0) {
            return Self::Rounding;
        }
        let slope = number("slope").unwrap_or(f64::NAN);
        match row["energy"]["verdict"].as_str() {
            Some("round-off") => Self::Rounding,
            Some("bounded") => Self::Swings(number("amplitude").unwrap_or(most)),
            Some("linear drift") => Self::Drifts(slope),
            Some("random walk") => Self::Wanders(most),
            _ => {
                // The interval of a slope shrinks as the length of the run to the power -3/2; the test takes 2.75 standard errors, the
                // interval 2.04.
                let longer = number("slope_ci").map(|interval| (1.35 * interval / slope.abs()).powf(2.0 / 3.0));
                let run = row["duration"].as_f64().unwrap_or(f64::NAN);
                // Beyond that the motion has other news.
                Self::Open(longer.filter(|longer| (1.0..100.0).contains(longer)).map(|longer| longer * run))
            }
        }
    }

    /// In a cell of a table.
    pub(crate) fn cell(self) -> String {
        match self {
            Self::Rounding => "no, rounding".to_owned(),
            Self::Swings(amplitude) => format!("no, swings by {amplitude:.1e} J"),
            Self::Drifts(slope) => format!("drifts, {slope:+.1e} J/s"),
            Self::Wanders(most) => format!("wanders, {most:.1e} J"),
            Self::Open(None) => "not clear".to_owned(),
            Self::Open(Some(length)) => format!("not clear before {length:.0e} s"),
        }
    }
}

/// Whether the constraint is off by more than rounding.
pub(crate) fn slips(row: &Value) -> bool {
    row["constraint"]["max"].as_f64().is_none_or(|slip| slip > rounding(row))
}

/// The possible rounding in a run: each step adds its own.
fn rounding(row: &Value) -> f64 {
    row["steps"].as_f64().unwrap_or(0.0) * f64::EPSILON
}
