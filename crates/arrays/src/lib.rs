//! Archives of NumPy arrays (`.npz`): columns of numbers under their names, and a text that says what they are.

mod archive;

use archive::Archive;
use std::io::{Error, ErrorKind, Result, Seek, Write};

/// A column of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArrayColumn<'a> {
    /// Its name.
    pub name: &'a str,
    /// Whether its numbers are whole: its array is then one of 64-bit integers.
    pub whole: bool,
}

/// So many numbers are in memory at a time (8 MiB), and as many again as bytes.
const HELD: usize = 1 << 20;

/// Writes an archive of arrays of `count` numbers, one for each column, and one array `metadata` that holds a text alone. `rows` gives the rows
/// to its sink, all of them once: they are gone through in one pass, whatever their number.
///
/// # Errors
/// Those of writing and of `rows`, and [`ErrorKind::InvalidData`] where there are not `count` rows.
pub fn write(
    file: &mut (impl Write + Seek),
    columns: &[ArrayColumn<'_>],
    count: u64,
    metadata: &str,
    rows: impl FnOnce(&mut dyn FnMut(&[f64]) -> Result<()>) -> Result<()>,
) -> Result<()> {
    let mut archive = Archive::new(file);
    for ArrayColumn { name, whole } in columns {
        let kind = if *whole { "<i8" } else { "<f8" };
        archive.reserve(format!("{name}.npy"), header(kind, &format!("({count},)")), 8 * count);
    }
    let (mut held, mut made) = (Vec::new(), 0);
    let mut flush = |held: &mut Vec<f64>| {
        for (k, column) in columns.iter().enumerate() {
            let numbers = held.iter().skip(k).step_by(columns.len());
            let bytes = numbers.flat_map(|x| if column.whole { (*x as i64).to_le_bytes() } else { x.to_le_bytes() });
            archive.add(k, &bytes.collect::<Vec<u8>>())?;
        }
        held.clear();
        Ok::<(), Error>(())
    };
    rows(&mut |row| {
        held.extend_from_slice(row);
        made += 1;
        if held.len() >= HELD { flush(&mut held) } else { Ok(()) }
    })?;
    if made != count {
        return Err(Error::new(ErrorKind::InvalidData, format!("{made} rows in place of {count}")));
    }
    flush(&mut held)?;
    let characters: Vec<u8> = metadata.chars().flat_map(|character| u32::from(character).to_le_bytes()).collect();
    let kind = format!("<U{}", characters.len() / 4);
    archive.reserve("metadata.npy".to_owned(), header(&kind, "()"), characters.len() as u64);
    archive.add(columns.len(), &characters)?;
    archive.finish()
}

/// The header of an array: the format `.npy`, version 1.
fn header(kind: &str, shape: &str) -> Vec<u8> {
    const ALIGNED: usize = 64;
    let begin = b"\x93NUMPY\x01\x00";
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    let length = begin.len() + 2 + header.len() + 1;
    header.push_str(&" ".repeat(length.next_multiple_of(ALIGNED) - length));
    header.push('\n');
    // A header of a hundred bytes fits.
    let size = u16::try_from(header.len()).unwrap_or(u16::MAX).to_le_bytes();
    begin.iter().copied().chain(size).chain(header.into_bytes()).collect()
}
