use crate::error::CliError;
use crate::files::{check_file, ending};
use crate::provenance::metadata_of;
use arrays::ArrayColumn;
use scene::Column;
use std::io::{Error, Seek, Write};
use std::path::Path;

/// The formats in which rows of numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    /// Comma-separated values, with a header.
    Csv,
    /// A JSON object on each line.
    Jsonl,
    /// An archive of NumPy arrays.
    Npz,
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    /// The one that is asked for, or that the ending of the file's name says.
    pub(crate) fn of(path: &Path, asked: Option<Self>) -> Result<Self, CliError> {
        if let Some(format) = asked {
            return Ok(format);
        }
        match ending(path).as_str() {
            #[cfg(not(feature = "parquet"))]
            "parquet" => Err(CliError::WithoutParquet { path: path.to_owned() }),
            ending => Self::named(ending).ok_or_else(|| CliError::Ending { path: path.to_owned() }),
        }
    }

    fn named(name: &str) -> Option<Self> {
        match name {
            "csv" => Some(Self::Csv),
            "jsonl" => Some(Self::Jsonl),
            "npz" => Some(Self::Npz),
            #[cfg(feature = "parquet")]
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }

    /// Writes `count` rows of numbers in a format that is no text, with a document that describes them; all rows need not be in memory at
    /// once.
    pub(crate) fn write_numbers(
        self,
        file: &mut (impl Write + Seek + Send),
        columns: &[Column],
        (count, document): (u64, &str),
        mut rows: impl Iterator<Item = Result<Vec<f64>, Error>>,
    ) -> Result<(), Error> {
        match self {
            Self::Npz => {
                let entries = columns.iter().map(|Column { name, whole, .. }| ArrayColumn { name, whole: *whole });
                let entries: Vec<_> = entries.collect();
                arrays::write(file, &entries, count, document, |push| rows.try_for_each(|row| push(&row?)))
            }
            #[cfg(feature = "parquet")]
            Self::Parquet => crate::parquet_file::write(file, columns, document, rows),
            Self::Csv | Self::Jsonl => Ok(()),
        }
    }

    /// Checks, before the work begins, the file of metadata that a text format has beside `path`.
    pub(crate) fn check_metadata(self, path: &Path, overwrite: bool) -> Result<(), CliError> {
        if self.is_text() { check_file(&metadata_of(path), overwrite) } else { Ok(()) }
    }

    /// Whether rows are lines of text, that can be written as they come.
    pub(crate) fn is_text(self) -> bool {
        matches!(self, Self::Csv | Self::Jsonl)
    }
}

impl std::str::FromStr for Format {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let without = if cfg!(feature = "parquet") { "" } else { "; this program was built without parquet" };
        Self::named(name).ok_or_else(|| format!("accepted are csv, jsonl, npz and parquet{without}"))
    }
}

/// The header of a `.csv` file (RFC 4180) with columns of these headings.
pub(crate) fn csv_header(headings: impl IntoIterator<Item = String>) -> String {
    headings.into_iter().map(|heading| quoted(&heading)).collect::<Vec<_>>().join(",")
}

/// A text field of a `.csv` file. It is quoted if it contains a separator, a quote or a line break, or if a spreadsheet would read it as a formula.
pub(crate) fn quoted(text: &str) -> String {
    let formula = text.starts_with(['=', '+', '-', '@']) && text.parse::<f64>().is_err();
    if formula || text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
