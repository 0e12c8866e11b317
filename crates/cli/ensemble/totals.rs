use super::members::COLUMNS;
use crate::table;
use scene::Sweep;
use serde_json::{Value, json};
use std::path::Path;

/// What all members came to.
pub(super) struct Totals {
    keys: usize,
    count: u64,
    failed: u64,
    first: Option<String>,
    /// Least, largest and sum of every column, and of the exponent; how many there are of each.
    columns: Vec<Column>,
}

#[derive(Clone, Copy)]
struct Column {
    low: f64,
    high: f64,
    sum: f64,
    count: u64,
}

impl Totals {
    pub(super) fn new(keys: usize) -> Self {
        let none = Column { low: f64::INFINITY, high: f64::NEG_INFINITY, sum: 0.0, count: 0 };
        Self { keys, count: 0, failed: 0, first: None, columns: vec![none; COLUMNS.len() + 1] }
    }

    /// Takes in a member.
    pub(super) fn add(&mut self, values: &[f64], error: Option<&str>) {
        self.count += 1;
        if let Some(error) = error {
            self.failed += 1;
            let number = self.count - 1;
            self.first.get_or_insert_with(|| format!("member {number}: {error}"));
            return;
        }
        for (column, value) in self.columns.iter_mut().zip(&values[self.keys..]) {
            if !value.is_nan() {
                (column.low, column.high) = (column.low.min(*value), column.high.max(*value));
                (column.sum, column.count) = (column.sum + value, column.count + 1);
            }
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// What failed, told in one line.
    pub(super) fn failures(&self) -> Option<String> {
        let first = self.first.as_ref()?;
        Some(format!("{} of {} members failed, the first so: {first}", self.failed, self.count))
    }

    fn named(&self) -> impl Iterator<Item = (&'static str, &'static str, Column)> {
        let names = COLUMNS.iter().copied().chain([("exponent", "1/s")]);
        names
            .zip(&self.columns)
            .filter(|(_, column)| column.count > 0)
            .map(|((name, unit), column)| (name, unit, *column))
    }

    pub(super) fn json(&self, sweep: &Sweep, seconds: f64, computed: u64) -> Value {
        let column = |(name, _, c): (&str, &str, Column)| {
            (name.to_owned(), json!({"min": c.low, "max": c.high, "mean": c.sum / c.count as f64}))
        };
        let run = &sweep.scene.run;
        json!({
            "scene": sweep.scene.name,
            "method": run.method,
            "step": run.actual_step(),
            "duration": run.duration,
            "keys": sweep.keys().collect::<Vec<_>>(),
            "members": self.count,
            "failed": self.failed,
            "wall_seconds": seconds,
            "computed": computed,
            "columns": self.named().map(column).collect::<serde_json::Map<_, _>>(),
        })
    }

    pub(super) fn text(&self, sweep: &Sweep, seconds: f64, computed: u64, file: Option<&Path>) -> String {
        let run = &sweep.scene.run;
        let mut lines = vec![
            ("scene".to_owned(), format!("{} ({})", sweep.scene.title, sweep.scene.name)),
            (
                "run".to_owned(),
                format!(
                    "{} s by {} with steps of {} s, each",
                    table::number(run.duration),
                    run.method,
                    table::number(run.actual_step())
                ),
            ),
            ("varied".to_owned(), sweep.keys().collect::<Vec<_>>().join(", ")),
            ("members".to_owned(), format!("{} of {}, {} failed", self.count, sweep.count(), self.failed)),
        ];
        for (name, unit, c) in self.named().skip(1) {
            let [low, high, mean] = [c.low, c.high, c.sum / c.count as f64].map(table::number);
            lines.push((name.to_owned(), format!("from {low} to {high} {unit}, {mean} on average")));
        }
        let each = 1e6 * seconds / computed.max(1) as f64;
        lines.push(("time".to_owned(), format!("{seconds:.3e} s, {each:.2} us a member")));
        if let Some(path) = file {
            lines.push(("written".to_owned(), path.display().to_string()));
        }
        table::aligned(&lines)
    }
}
