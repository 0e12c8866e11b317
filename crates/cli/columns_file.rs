//! Reads files of columns of numbers back.

use crate::error::CliError;
use crate::files::ending;
use crate::format::Format;
use crate::provenance::named;
use scene::Column;
use std::fs::File;
use std::io::{Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// A column of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NamedColumn {
    pub(crate) name: String,
    /// Empty if the file does not say it.
    pub(crate) unit: String,
    pub(crate) values: Vec<f64>,
}

/// The columns of a file; a column of texts is not among them.
pub(crate) type Columns = Vec<NamedColumn>;

/// Reads a file, by the ending of its name.
pub(crate) fn read(path: &Path) -> Result<Columns, CliError> {
    // A device might never end.
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        let source = Error::new(ErrorKind::InvalidInput, "the path is not a regular file");
        return Err(CliError::Read { path: path.to_owned(), source });
    }
    let columns = match ending(path).as_str() {
        "csv" => csv(path),
        "npz" => npz(path),
        _ => {
            let problem = "accepted is a file .csv or .npz, by the ending of its name";
            return Err(CliError::Request(format!("{}: {problem}", path.display())));
        }
    };
    columns.map_err(|source| CliError::Read { path: path.to_owned(), source })
}

/// The columns all of whose fields are numbers. Names lose their units, so that the formats have the same.
fn csv(path: &Path) -> Result<Columns, Error> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_path(path)?;
    let mut columns: Vec<(NamedColumn, bool)> = Vec::new();
    for heading in reader.headers()? {
        let (name, unit) = named(heading);
        let (name, unit) = (name.to_owned(), unit.unwrap_or_default().to_owned());
        let mut column = NamedColumn { name, unit, values: Vec::new() };
        let copies = columns.iter().filter(|(other, _)| other.name.split('.').next() == Some(&column.name)).count();
        // Two columns of one name are told apart, as pandas does it.
        if copies > 0 {
            column.name += &format!(".{copies}");
        }
        columns.push((column, true));
    }
    for record in reader.records() {
        for (cell, (column, numbers)) in record?.iter().zip(&mut columns) {
            // An empty cell is a missing number.
            let number = if cell.is_empty() { Ok(f64::NAN) } else { cell.parse() };
            *numbers &= number.is_ok();
            column.values.push(number.unwrap_or(f64::NAN));
        }
    }
    Ok(columns.into_iter().filter(|(_, numbers)| *numbers).map(|(column, _)| column).collect())
}

fn npz(path: &Path) -> Result<Columns, Error> {
    let invalid = |error: zip::result::ZipError| Error::new(ErrorKind::InvalidData, error);
    let mut archive = zip::ZipArchive::new(File::open(path)?).map_err(invalid)?;
    let mut columns = Vec::new();
    for number in 0..archive.len() {
        let file = archive.by_index(number).map_err(invalid)?;
        let name = file.name().map_err(invalid)?.into_owned();
        let Some(name) = npyz::npz::array_name_from_file_name(&name).map(str::to_owned) else { continue };
        let array = npyz::NpyFile::new(file)?;
        // An array of texts is not a column of numbers.
        let values: Option<Vec<f64>> = match array.try_data::<f64>() {
            Ok(numbers) => Some(numbers.collect::<Result<_, _>>()?),
            Err(array) => {
                array.into_vec::<i64>().ok().map(|whole| whole.into_iter().map(|number| number as f64).collect())
            }
        };
        columns.extend(values.map(|values| NamedColumn { name, unit: String::new(), values }));
    }
    Ok(columns)
}

/// Writes the first rows of a file of numbers as they were before the file was made from them: row after row, eight bytes a number. Fewer
/// are written if the file has fewer.
///
/// # Errors
/// The errors of the files, and [`ErrorKind::InvalidData`] if the file does not have these columns.
pub(crate) fn copy_rows(
    path: &Path,
    format: Format,
    columns: &[Column],
    rows: u64,
    to: &mut impl Write,
) -> Result<(), Error> {
    match format {
        Format::Npz => of_npz(path, columns, rows, to),
        #[cfg(feature = "parquet")]
        Format::Parquet => {
            let labels: Vec<String> = columns.iter().map(crate::provenance::label).collect();
            let mut write = |row: &[f64]| row.iter().try_for_each(|number| to.write_all(&number.to_le_bytes()));
            crate::parquet_file::read(path, &labels, rows, &mut write)
        }
        Format::Csv | Format::Jsonl => Ok(()),
    }
}

/// Number of bytes of the columns that are in memory at a time.
const HELD: usize = 8 << 20;

/// Some rows of every column at a time, from one open file.
fn of_npz(path: &Path, columns: &[Column], rows: u64, to: &mut impl Write) -> Result<(), Error> {
    const NUMBER: usize = size_of::<f64>();
    let invalid = |problem: String| Error::new(ErrorKind::InvalidData, problem);
    let mut file = File::open(path)?;
    let mut archive = zip::ZipArchive::new(&file).map_err(|error| invalid(error.to_string()))?;
    let (mut begins, mut left) = (Vec::with_capacity(columns.len()), rows);
    for column in columns {
        let name = npyz::npz::file_name_from_array_name(&column.name);
        let entry = archive.by_name(&name).map_err(|error| invalid(error.to_string()))?;
        let stored = entry.compression() == zip::CompressionMethod::Stored;
        let begin =
            entry.data_start().filter(|_| stored).ok_or_else(|| invalid("the arrays are compressed".to_owned()))?;
        let size = entry.size();
        let array = npyz::NpyFile::new(entry)?;
        let count = array.len();
        array.try_data::<f64>().map_err(|_| invalid("an array is not one of doubles".to_owned()))?;
        let header = size.checked_sub(count.saturating_mul(NUMBER as u64));
        begins.push(begin + header.ok_or_else(|| invalid("an array is too short".to_owned()))?);
        left = left.min(count);
    }
    drop(archive);
    let (width, mut done) = (columns.len(), 0);
    let together = (HELD / (NUMBER * width.max(1))).max(1) as u64;
    while left > 0 {
        let some = left.min(together) as usize;
        let mut bytes = vec![0; NUMBER * width * some];
        let mut column = vec![0; NUMBER * some];
        for (k, begin) in begins.iter().enumerate() {
            file.seek(SeekFrom::Start(begin + done * NUMBER as u64))?;
            file.read_exact(&mut column)?;
            for (number, row) in column.chunks_exact(NUMBER).zip(bytes.chunks_exact_mut(NUMBER * width)) {
                row[NUMBER * k..][..NUMBER].copy_from_slice(number);
            }
        }
        to.write_all(&bytes)?;
        (left, done) = (left - some as u64, done + some as u64);
    }
    Ok(())
}
