use super::about::About;
use super::rows::parsed;
use crate::table;
use scene::Column;
use serde_json::{Value, json};
use std::path::Path;

/// The totals over all members.
pub(super) struct EnsembleTotals {
    keys: usize,
    /// The number of the first member.
    begin: u64,
    count: u64,
    failed: u64,
    first: Option<String>,
    /// Least, largest, mean and deviation of every column, and of the exponent; how many there are of each.
    columns: Vec<(Column, Extent)>,
}

#[derive(Clone, Copy)]
struct Extent {
    low: f64,
    high: f64,
    sum: f64,
    count: u64,
    /// The mean so far, and the sum of the squares of the distances from the mean, kept so that no digits cancel (Welford 1962).
    center: f64,
    squares: f64,
}

impl Extent {
    const NONE: Self =
        Self { low: f64::INFINITY, high: f64::NEG_INFINITY, sum: 0.0, count: 0, center: 0.0, squares: 0.0 };

    fn add(&mut self, value: f64) {
        (self.low, self.high) = (self.low.min(value), self.high.max(value));
        (self.sum, self.count) = (self.sum + value, self.count + 1);
        let off = value - self.center;
        self.center += off / self.count as f64;
        self.squares += off * (value - self.center);
    }

    fn mean(&self) -> f64 {
        self.sum / self.count as f64
    }

    /// The standard deviation of what the numbers are a sample of; not a number of a single one.
    fn deviation(&self) -> f64 {
        (self.squares / (self.count as f64 - 1.0)).sqrt()
    }
}

impl EnsembleTotals {
    /// The totals of a sweep from the member `begin` on.
    pub(super) fn new(of: &About, begin: u64) -> Self {
        let keys = of.keys.len();
        // After the number of the member and its keys.
        let columns = of.columns().into_iter().skip(1 + keys).map(|column| (column, Extent::NONE)).collect();
        Self { keys, begin, count: 0, failed: 0, first: None, columns }
    }

    /// Takes in a member.
    pub(super) fn add(&mut self, values: &[f64], error: Option<&str>) {
        self.count += 1;
        if let Some(error) = error {
            self.failed += 1;
            let number = self.begin + self.count - 1;
            self.first.get_or_insert_with(|| format!("member {number}: {error}"));
            return;
        }
        for ((_, column), value) in self.columns.iter_mut().zip(&values[self.keys..]) {
            if !value.is_nan() {
                column.add(*value);
            }
        }
    }

    /// Takes in a member by its row.
    pub(super) fn take(&mut self, row: &str) {
        let (values, error) = parsed(row);
        self.add(&values, error.as_deref());
    }

    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// The failures, in one line; `None` if no member failed.
    pub(super) fn failures(&self) -> Option<String> {
        let first = self.first.as_ref()?;
        Some(format!("{} of {} members failed; the first failure: {first}", self.failed, self.count))
    }

    fn named(&self) -> impl Iterator<Item = &(Column, Extent)> {
        self.columns.iter().filter(|(_, extent)| extent.count > 0)
    }

    pub(super) fn json(&self, of: &About, seconds: f64, computed: u64) -> Value {
        let column = |(column, c): &(Column, Extent)| {
            let told = json!({"min": c.low, "max": c.high, "mean": c.mean(), "deviation": c.deviation()});
            (column.name.clone(), told)
        };
        json!({
            "scene": of.scene,
            "method": of.method,
            "step": of.step,
            "duration": of.duration,
            "keys": of.keys,
            "members": self.count,
            "failed": self.failed,
            "wall_seconds": seconds,
            "computed": computed,
            "columns": self.named().map(column).collect::<serde_json::Map<_, _>>(),
        })
    }

    pub(super) fn text(&self, of: &About, seconds: f64, computed: u64, file: Option<&Path>) -> String {
        let mut lines = vec![
            ("scene".to_owned(), format!("{} ({})", of.title, of.scene)),
            (
                "run".to_owned(),
                format!(
                    "each member: {} s by {} with steps of {} s{}",
                    table::number(of.duration),
                    of.method,
                    table::number(of.step),
                    if of.keys.iter().any(|key| key.starts_with("run.")) { ", where they do not vary" } else { "" }
                ),
            ),
            ("varied".to_owned(), of.keys.join(", ")),
            ("members".to_owned(), format!("{} of {}, {} failed", self.count, of.members, self.failed)),
        ];
        for (Column { name, unit, .. }, c) in self.named().skip(1) {
            let [low, high, mean] = [c.low, c.high, c.mean()].map(table::number);
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            lines.push((name.clone(), format!("from {low} to {high}{unit}, mean {mean}")));
        }
        // Results that were only put together have no time.
        if computed > 0 {
            let each = 1e6 * seconds / computed as f64;
            lines.push(("time".to_owned(), format!("{seconds:.3e} s, {each:.2} us a member")));
        }
        if let Some(path) = file {
            lines.push(("written".to_owned(), path.display().to_string()));
        }
        table::aligned(&lines)
    }
}
