//! Verdicts on constraint and energy from rows of `compare --json`, and the totals of each method over all scenes.

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

/// The runs of all methods, in the order in which they were first seen.
#[derive(Debug, Default)]
pub(crate) struct Totals(Vec<Total>);

#[derive(Debug, Default)]
struct Total {
    method: String,
    made: bool,
    refused: u32,
    failed: u32,
    slips: u32,
    /// The largest residual of the constraint (m/s).
    slip: f64,
    drifts: u32,
    open: u32,
    seconds: f64,
}

/// The columns of the totals: in how many scenes a method refuses, fails, slips (at most so far), drifts, or is not clear; and its time.
pub(crate) const COLUMNS: [&str; 8] =
    ["method", "refused", "failed", "slips", "at most", "drifts", "not clear", "time [s]"];

impl Totals {
    /// Counts a row of `compare --json`.
    pub(crate) fn add(&mut self, row: &Value) {
        let method = row["method"].as_str().unwrap_or_default();
        let known = self.0.iter().position(|total| total.method == method);
        let place = known.unwrap_or_else(|| {
            self.0.push(Total { method: method.to_owned(), ..Total::default() });
            self.0.len() - 1
        });
        let total = &mut self.0[place];
        if row["refused"] == true {
            total.refused += 1;
        } else if row.get("failure").is_some() {
            total.failed += 1;
        } else {
            let energy = Energy::of(row);
            total.made = true;
            total.slips += u32::from(slips(row));
            total.slip = row["constraint"]["max"].as_f64().map_or(f64::NAN, |slip| slip.max(total.slip));
            total.drifts += u32::from(matches!(energy, Energy::Drifts(_)));
            total.open += u32::from(matches!(energy, Energy::Open(_)));
            total.seconds += row["wall_seconds"].as_f64().unwrap_or(f64::NAN);
        }
    }

    /// The rows of the [`COLUMNS`], one for each method.
    pub(crate) fn rows(&self) -> Vec<Vec<String>> {
        let cells = |total: &Total| {
            let counts = [total.refused, total.failed, total.slips].map(|count| count.to_string());
            let slip = if total.made { format!("{:.1e}", total.slip) } else { "-".to_owned() };
            let rest = [slip, total.drifts.to_string(), total.open.to_string(), format!("{:.1e}", total.seconds)];
            [vec![total.method.clone()], counts.to_vec(), rest.to_vec()].concat()
        };
        self.0.iter().map(cells).collect()
    }
}
