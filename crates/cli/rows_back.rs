//! Reads the rows of a finished output back, so that a longer run can go on from them.

use crate::format::Format;
use scene::Column;
use std::fs::File;
use std::io::{BufReader, Error, ErrorKind, Seek, SeekFrom, Write};
use std::path::Path;

/// Writes the first rows of a file of numbers as they were before the file was made of them: row after row, eight bytes a number. There
/// are fewer where the file has fewer.
///
/// # Errors
/// Those of the files, and [`ErrorKind::InvalidData`] where the file does not have these columns.
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

fn write_row(row: &[f64], to: &mut impl Write) -> Result<(), Error> {
    row.iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))
}

/// Each column has a reader of its own, so that the memory holds one row.
fn of_npz(path: &Path, columns: &[Column], rows: u64, to: &mut impl Write) -> Result<(), Error> {
    let mut readers = Vec::new();
    for column in columns {
        let mut file = File::open(path)?;
        let name = npyz::npz::file_name_from_array_name(&column.name);
        let invalid = |error: zip::result::ZipError| Error::new(ErrorKind::InvalidData, error);
        let mut archive = zip::ZipArchive::new(&file).map_err(invalid)?;
        let entry = archive.by_name(&name).map_err(invalid)?;
        let stored = entry.compression() == zip::CompressionMethod::Stored;
        let begin = entry.data_start().filter(|_| stored);
        let begin = begin.ok_or_else(|| Error::new(ErrorKind::InvalidData, "the arrays are compressed"))?;
        drop(entry);
        drop(archive);
        file.seek(SeekFrom::Start(begin))?;
        let array = npyz::NpyFile::new(BufReader::with_capacity(1 << 15, file))?;
        readers.push(array.data::<f64>().map_err(|error| Error::new(ErrorKind::InvalidData, error.to_string()))?);
    }
    let mut row = Vec::with_capacity(columns.len());
    for _ in 0..rows {
        row.clear();
        for reader in &mut readers {
            let Some(number) = reader.next() else { return Ok(()) };
            row.push(number?);
        }
        write_row(&row, to)?;
    }
    Ok(())
}
