//! Reads the rows of a finished output back, so that a longer run can go on from them.

use crate::format::Format;
use scene::Column;
use std::fs::File;
use std::io::{Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Writes the first rows of a file of numbers as they were before the file was made from them: row after row, eight bytes a number. Fewer
/// are written if the file has fewer.
///
/// # Errors
/// The errors of the files, and [`ErrorKind::InvalidData`] if the file does not have these columns.
pub(crate) fn copy(
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
            crate::parquet_file::read(path, &labels, rows, |row| write_row(row, to))
        }
        Format::Csv | Format::Jsonl => Ok(()),
    }
}

#[cfg(feature = "parquet")]
fn write_row(row: &[f64], to: &mut impl Write) -> Result<(), Error> {
    row.iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))
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
