//! `noslip diff`: how far two files of numbers are apart.

use crate::args::DiffArguments;
use crate::columns_file::{self, Columns, NamedColumn};
use crate::error::CliError;
use crate::{table, terminal};
use serde_json::{Value, json};
use std::fmt::Write;

/// The largest difference in a column, and its row.
struct Difference {
    name: String,
    size: f64,
    row: usize,
    values: [f64; 2],
}

/// Compares the columns that both files have, row by row.
pub(crate) fn diff(arguments: &DiffArguments) -> Result<(), CliError> {
    let DiffArguments { first, second, within, json } = arguments;
    let [a, b] = [columns_file::read(first)?, columns_file::read(second)?];
    let differences: Vec<Difference> = a
        .iter()
        .filter_map(|NamedColumn { name, values, .. }| {
            let others = &b.iter().find(|other| other.name == *name)?.values;
            Some(largest(name, values, others))
        })
        .collect();
    if differences.is_empty() {
        let problem = format!("{} and {} have no column in common", first.display(), second.display());
        return Err(CliError::Request(problem));
    }
    let files = [first.display().to_string(), second.display().to_string()];
    if *json {
        terminal::print_json(&object(&files, [&a, &b], &differences))?;
    } else {
        terminal::print(&text(&files, [&a, &b], &differences))?;
    }
    let Some(within) = within else { return Ok(()) };
    let far = differences.iter().filter(|difference| difference.size > *within);
    let mut far: Vec<String> = far
        .map(|far| format!("the column {} differs by {:e}, which is more than {within:e}", far.name, far.size))
        .collect();
    if rows(&a) != rows(&b) {
        far.push(format!("the files have {} and {} rows", rows(&a), rows(&b)));
    }
    far.extend(alone(&a, &b).chain(alone(&b, &a)).map(|name| format!("only one file has the column {name}")));
    CliError::of_failures(far)
}

fn rows(columns: &Columns) -> usize {
    columns.iter().map(|column| column.values.len()).max().unwrap_or(0)
}

/// The columns of one file that the other does not have.
fn alone<'a>(one: &'a Columns, other: &'a Columns) -> impl Iterator<Item = &'a str> {
    one.iter().map(|column| column.name.as_str()).filter(|name| !other.iter().any(|other| other.name == *name))
}

/// The largest difference of two columns. Two NaNs do not differ; a NaN and a number differ by infinity.
fn largest(name: &str, values: &[f64], others: &[f64]) -> Difference {
    let mut found = Difference { name: name.to_owned(), size: 0.0, row: 0, values: [f64::NAN; 2] };
    for (row, (a, b)) in values.iter().zip(others).enumerate() {
        let size = match (a.is_nan(), b.is_nan()) {
            (true, true) => 0.0,
            (false, false) if a.to_bits() == b.to_bits() => 0.0,
            (false, false) => (a - b).abs(),
            _ => f64::INFINITY,
        };
        if size > found.size || row == 0 {
            found = Difference { size, row, values: [*a, *b], ..found };
        }
    }
    found
}

fn text(files: &[String; 2], [a, b]: [&Columns; 2], differences: &[Difference]) -> String {
    let cells = |difference: &Difference| {
        let [a, b] = difference.values;
        let size = if difference.size == 0.0 { "0".to_owned() } else { format!("{:.2e}", difference.size) };
        if difference.size == 0.0 {
            return vec![difference.name.clone(), size];
        }
        vec![
            difference.name.clone(),
            size,
            difference.row.to_string(),
            harness::precision::number(a),
            harness::precision::number(b),
        ]
    };
    let header = ["column", "largest difference", "in row", &files[0], &files[1]];
    let mut text = table::right_aligned(&header, &differences.iter().map(cells).collect::<Vec<_>>());
    if rows(a) != rows(b) {
        let (a, b) = (rows(a), rows(b));
        let _ = writeln!(text, " the files have {a} and {b} rows: only the first {} are compared", a.min(b));
    }
    for (file, only) in [(&files[0], alone(a, b).collect::<Vec<_>>()), (&files[1], alone(b, a).collect())] {
        if !only.is_empty() {
            let _ = writeln!(text, " only {file} has the columns {}", only.join(", "));
        }
    }
    text
}

fn object(files: &[String; 2], [a, b]: [&Columns; 2], differences: &[Difference]) -> Value {
    let one = |difference: &Difference| {
        let Difference { name, size, row, values: [a, b] } = difference;
        // JSON has no number that is not finite: an infinite difference becomes null.
        json!({"name": name, "difference": size, "row": row, "a": a, "b": b, "same": *size == 0.0})
    };
    let columns: Vec<Value> = differences.iter().map(one).collect();
    let only = |one, other| alone(one, other).map(str::to_owned).collect::<Vec<_>>();
    json!({"files": files, "rows": [rows(a), rows(b)], "columns": columns, "only": [only(a, b), only(b, a)]})
}
