use super::lines;
use super::spool::Rows;
use crate::first_error::FirstError;
use crate::trajectory_file::Format;
use std::io::{Error, Seek, Write};

/// Writes a result in a format; `rows` begins to read them again.
pub(super) fn write<'a>(
    file: &mut (impl Write + Seek + Send),
    format: Format,
    columns: &[(String, &'static str)],
    count: u64,
    rows: &impl Fn() -> Result<Rows<'a>, Error>,
) -> Result<(), Error> {
    let labels = columns.iter().map(|(name, unit)| label(name, unit));
    match format {
        Format::Csv => {
            writeln!(file, "{},error", labels.collect::<Vec<_>>().join(","))?;
            let mut rows = rows()?;
            while let Some(row) = rows.next()? {
                writeln!(file, "{row}")?;
            }
            Ok(())
        }
        Format::Npz => {
            let mut file = FirstError::new(file);
            let outcome = npz(&mut file, columns, count, rows);
            // What stopped the file is the reason of whatever the archive then stumbled over.
            file.into_result().and(outcome)
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => {
            let mut rows = rows()?;
            let all = 0..columns.len();
            let row = |text: &str| all.clone().map(|column| lines::value(text, column)).collect();
            let next = || rows.next().map(|text| text.map(row)).transpose();
            crate::parquet_file::write_groups(file, labels.collect(), std::iter::from_fn(next))
        }
    }
}

fn label(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// An archive with an array for each column, one after the other, and one that says which members failed.
fn npz<'a>(
    file: &mut (impl Write + Seek),
    columns: &[(String, &'static str)],
    count: u64,
    rows: &impl Fn() -> Result<Rows<'a>, Error>,
) -> Result<(), Error> {
    use npyz::WriterBuilder;
    let mut archive = zip::ZipWriter::new(file);
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored).large_file(true);
    let names = columns.iter().map(|(name, _)| name.as_str()).chain(["failed"]);
    for (column, name) in names.enumerate() {
        archive.start_file(npyz::npz::file_name_from_array_name(name), options)?;
        let mut array = npyz::WriteOptions::new().default_dtype().shape(&[count]).writer(&mut archive).begin_nd()?;
        let mut rows = rows()?;
        while let Some(row) = rows.next()? {
            array.push(&lines::value(row, column))?;
        }
        array.finish()?;
    }
    archive.finish()?;
    Ok(())
}
