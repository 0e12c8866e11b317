//! The totals of each method over all scenes.

use crate::row_verdict::{Energy, slips};
use crate::table;
use serde_json::Value;

/// The runs of all methods, in the order in which they were first seen.
#[derive(Debug, Default)]
pub(crate) struct Totals(Vec<Total>);

#[derive(Debug, Default)]
struct Total {
    method: String,
    made: u32,
    refused: u32,
    failed: u32,
    slips: u32,
    /// The largest residual of the constraint (m/s).
    slip: f64,
    drifts: u32,
    open: u32,
    seconds: f64,
}

const COLUMNS: [&str; 9] =
    ["method", "runs", "refused", "failed", "slips in", "at most [m/s]", "drifts in", "not clear in", "time [s]"];

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
            total.made += 1;
            total.slips += u32::from(slips(row));
            total.slip = row["constraint"]["max"].as_f64().map_or(f64::NAN, |slip| slip.max(total.slip));
            total.drifts += u32::from(matches!(energy, Energy::Drifts(_)));
            total.open += u32::from(matches!(energy, Energy::Open(_)));
            total.seconds += row["wall_seconds"].as_f64().unwrap_or(f64::NAN);
        }
    }

    /// One line a method.
    pub(crate) fn table(&self, scenes: usize) -> String {
        let cells = |total: &Total| {
            let counts = [total.made, total.refused, total.failed, total.slips].map(|count| count.to_string());
            let slip = if total.made == 0 { "-".to_owned() } else { format!("{:.1e}", total.slip) };
            let rest = [slip, total.drifts.to_string(), total.open.to_string(), format!("{:.1e}", total.seconds)];
            [vec![total.method.clone()], counts.to_vec(), rest.to_vec()].concat()
        };
        let rows: Vec<Vec<String>> = self.0.iter().map(cells).collect();
        format!("All {scenes} scenes together\n{}", table::right_aligned(&COLUMNS, &rows))
    }
}
