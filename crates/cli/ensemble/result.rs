use super::lines;
use super::rows::SpoolRows;
use crate::format::Format;
use crate::output::in_arrays;
use crate::provenance::label;
use scene::Column;
use std::io::{Error, Seek, Write};

/// The columns of a result, and what it says of itself.
pub(super) struct Shape<'a> {
    pub(super) format: Format,
    pub(super) columns: &'a [Column],
    pub(super) count: u64,
    pub(super) metadata: &'a str,
}

/// Writes a result in a format; `rows` begins to read them again.
pub(super) fn write<'a>(
    file: &mut (impl Write + Seek + Send),
    shape: &Shape<'_>,
    rows: &impl Fn() -> Result<SpoolRows<'a>, Error>,
) -> Result<(), Error> {
    let Shape { format, columns, count, metadata } = *shape;
    match format {
        Format::Csv => {
            let labels: Vec<String> = columns.iter().map(label).collect();
            writeln!(file, "{},error", labels.join(","))?;
            let mut rows = rows()?;
            while let Some(row) = rows.next()? {
                writeln!(file, "{row}")?;
            }
            Ok(())
        }
        Format::Jsonl => {
            let mut rows = rows()?;
            while let Some(row) = rows.next()? {
                writeln!(file, "{}", object(columns, row))?;
            }
            Ok(())
        }
        Format::Npz => {
            let columns = with_failed(columns);
            arrays::write(file, &in_arrays(&columns), count, metadata, |column, push| {
                let mut rows = rows()?;
                while let Some(row) = rows.next()? {
                    push(lines::value(row, column))?;
                }
                Ok(())
            })
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => {
            let (mut rows, columns) = (rows()?, with_failed(columns));
            let all = 0..columns.len();
            let row = |text: &str| all.clone().map(|column| lines::value(text, column)).collect();
            let next = || rows.next().map(|text| text.map(row)).transpose();
            crate::parquet_file::write(file, &columns, metadata, std::iter::from_fn(next))
        }
    }
}

/// The columns of a file of numbers alone: one more says which members failed, by 0 or 1.
fn with_failed(columns: &[Column]) -> Vec<Column> {
    columns.iter().cloned().chain([failed()]).collect()
}

/// Whether a member failed: 1, or 0.
pub(super) fn failed() -> Column {
    Column::whole("failed")
}

/// A row as an object; its member is a whole number, and what is not finite is null.
fn object(columns: &[Column], row: &str) -> serde_json::Value {
    let (values, error) = lines::parsed(row);
    let member: Option<u64> = row.split(',').next().and_then(|number| number.parse().ok());
    let mut object = serde_json::json!({ "member": member });
    for (column, value) in columns.iter().skip(1).zip(values) {
        object[column.name.as_str()] = serde_json::Number::from_f64(value).into();
    }
    object["error"] = error.into();
    object
}
