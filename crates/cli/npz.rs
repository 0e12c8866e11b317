use crate::first_error::FirstError;
use scene::Column;
use std::io::{Error, Seek, Write};

/// Writes an archive of NumPy arrays of one length, column by column, and one array `metadata` that holds a text alone; `numbers` gives
/// the numbers of a column to its sink. A column of whole numbers is an array of 64-bit integers.
pub(crate) fn write(
    file: &mut (impl Write + Seek),
    columns: &[Column],
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
            archive.start_file(npyz::npz::file_name_from_array_name(&column.name), options)?;
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
