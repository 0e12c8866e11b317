use super::rows::{SpoolRows, numbers_of, parsed};
use crate::error::CliError;
use crate::files::{as_written, write_whole};
use crate::format::{Format, csv_header};
use crate::provenance::{label, metadata_of};
use scene::Column;
use std::io::{Error, Seek, Write};
use std::path::Path;

/// The columns, row count and metadata of a result.
pub(super) struct Shape<'a> {
    pub(super) format: Format,
    pub(super) columns: &'a [Column],
    pub(super) count: u64,
    pub(super) metadata: &'a str,
}

impl Shape<'_> {
    /// Writes a result, whole or not at all. A text format gets its metadata file first, so that rows never lack it. `rows` begins to read
    /// the rows again. An identical result of an interrupted command is accepted.
    pub(super) fn write<'a>(
        &self,
        out: &Path,
        overwrite: bool,
        rows: &impl Fn() -> Result<SpoolRows<'a>, Error>,
    ) -> Result<(), CliError> {
        let again = !overwrite && out.symlink_metadata().is_ok();
        if again {
            as_written(out, |file| content(file, self, rows))?;
        }
        if self.format.is_text() {
            write_whole(&metadata_of(out), true, |file| file.write_all(self.metadata.as_bytes()))?;
        }
        if again {
            return Ok(());
        }
        write_whole(out, overwrite, |file| content(file, self, rows)).inspect_err(|_| {
            let _ = std::fs::remove_file(metadata_of(out));
        })
    }
}

/// Writes the rows in the format.
fn content<'a>(
    file: &mut (impl Write + Seek + Send),
    shape: &Shape<'_>,
    rows: &impl Fn() -> Result<SpoolRows<'a>, Error>,
) -> Result<(), Error> {
    let Shape { format, columns, count, metadata } = *shape;
    let mut rows = rows()?;
    match format {
        Format::Csv => {
            writeln!(file, "{},error", csv_header(columns.iter().map(label)))?;
            while let Some(row) = rows.next()? {
                writeln!(file, "{row}")?;
            }
            Ok(())
        }
        Format::Jsonl => {
            while let Some(row) = rows.next()? {
                writeln!(file, "{}", object(columns, row))?;
            }
            Ok(())
        }
        _ => {
            let columns = [columns, &[failed()]].concat();
            let numbers = || rows.next().map(|text| text.map(numbers_of)).transpose();
            format.write_numbers(file, &columns, (count, metadata), std::iter::from_fn(numbers))
        }
    }
}

/// The last column of a file of numbers: whether a member failed, 1 or 0.
pub(super) fn failed() -> Column {
    Column::whole("failed")
}

/// A row as a JSON object. The member is a whole number; a value that is not finite is null.
fn object(columns: &[Column], row: &str) -> serde_json::Value {
    let (values, error) = parsed(row);
    let member: Option<u64> = row.split(',').next().and_then(|number| number.parse().ok());
    let mut object = serde_json::json!({ "member": member });
    for (column, value) in columns.iter().skip(1).zip(values) {
        object[column.name.as_str()] = serde_json::Number::from_f64(value).into();
    }
    object["error"] = error.into();
    object
}
