//! Archives of NumPy arrays (`.npz`): columns of numbers under their names, and a text that says what they are.

mod first_error;

use first_error::FirstError;
use std::io::{Error, Seek, Write};

/// A column of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArrayColumn<'a> {
    /// Its name.
    pub name: &'a str,
    /// Whether its numbers are whole: its array is then one of 64-bit integers.
    pub whole: bool,
}

/// Writes an archive of arrays of one length, column by column, and one array `metadata` that holds a text alone; `numbers` gives the
/// numbers of a column to its sink.
///
/// # Errors
/// Those of writing, and those of `numbers`.
pub fn write(
    file: &mut (impl Write + Seek),
    columns: &[ArrayColumn<'_>],
    count: u64,
    metadata: &str,
    mut numbers: impl FnMut(usize, &mut dyn FnMut(f64) -> Result<(), Error>) -> Result<(), Error>,
) -> Result<(), Error> {
    use npyz::WriterBuilder;
    let mut file = FirstError::new(file);
    let mut archive = || -> Result<(), Error> {
        let mut archive = zip::ZipWriter::new(&mut file);
        let stored = zip::CompressionMethod::Stored;
        let options = zip::write::SimpleFileOptions::default().compression_method(stored).large_file(true);
        for (number, column) in columns.iter().enumerate() {
            archive.start_file(npyz::npz::file_name_from_array_name(column.name), options)?;
            if column.whole {
                let mut array =
                    npyz::WriteOptions::new().default_dtype().shape(&[count]).writer(&mut archive).begin_nd()?;
                numbers(number, &mut |value| array.push(&(value as i64)))?;
                array.finish()?;
            } else {
                let mut array =
                    npyz::WriteOptions::new().default_dtype().shape(&[count]).writer(&mut archive).begin_nd()?;
                numbers(number, &mut |value| array.push(&value))?;
                array.finish()?;
            }
        }
        archive.start_file(npyz::npz::file_name_from_array_name("metadata"), options)?;
        archive.write_all(&text_array(metadata))?;
        archive.finish()?;
        Ok(())
    };
    let outcome = archive();
    // What stopped the file is the reason of whatever the archive then stumbled over.
    file.into_result().and(outcome)
}

/// An array without dimensions that holds a text, four bytes for each character: the format `.npy`, version 1.
fn text_array(text: &str) -> Vec<u8> {
    const ALIGNED: usize = 64;
    let begin = b"\x93NUMPY\x01\x00";
    let mut header = format!("{{'descr': '<U{}', 'fortran_order': False, 'shape': (), }}", text.chars().count());
    let length = begin.len() + 2 + header.len() + 1;
    header.push_str(&" ".repeat(length.next_multiple_of(ALIGNED) - length));
    header.push('\n');
    // A header of a hundred bytes fits.
    let size = u16::try_from(header.len()).unwrap_or(u16::MAX).to_le_bytes();
    let characters = text.chars().flat_map(|character| u32::from(character).to_le_bytes());
    begin.iter().copied().chain(size).chain(header.into_bytes()).chain(characters).collect()
}
