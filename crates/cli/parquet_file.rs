use crate::provenance::label;
use parquet::basic::{Repetition, Type as Physical};
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnDescriptor, Type};
use scene::Column;
use std::fs::File;
use std::io::{Error, ErrorKind, Write};
use std::path::Path;
use std::sync::Arc;

/// Maximum number of rows in a group; a group also holds at most [`HELD`] numbers.
const GROUP: usize = 1 << 16;
const HELD: usize = 1 << 22;

/// Writes a table of numbers with these columns, whose rows need not be in memory all at once; `metadata` is the value of the key `noslip`.
pub(crate) fn write(
    file: &mut (impl Write + Send),
    columns: &[Column],
    metadata: &str,
    rows: impl Iterator<Item = Result<Vec<f64>, Error>>,
) -> Result<(), Error> {
    write_table(file, columns, metadata, rows).map_err(Error::other)
}

fn write_table(
    file: &mut (impl Write + Send),
    columns: &[Column],
    metadata: &str,
    mut rows: impl Iterator<Item = Result<Vec<f64>, Error>>,
) -> Result<(), ParquetError> {
    let field = |column: &Column| {
        let physical = if column.whole { Physical::INT64 } else { Physical::DOUBLE };
        let label = label(column);
        Type::primitive_type_builder(&label, physical).with_repetition(Repetition::REQUIRED).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<_, _>>()?;
    let schema = Type::group_type_builder("trajectory").with_fields(fields).build()?;
    // Hardly any number of a trajectory comes twice.
    let pairs = vec![KeyValue::new("noslip".to_owned(), metadata.to_owned())];
    let properties =
        WriterProperties::builder().set_dictionary_enabled(false).set_key_value_metadata(Some(pairs)).build();
    let mut file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    loop {
        let some =
            rows.by_ref().take(GROUP.min(HELD / columns.len().max(1)).max(1)).collect::<Result<Vec<_>, Error>>()?;
        if some.is_empty() {
            break;
        }
        let mut group = file.next_row_group()?;
        let mut number = 0;
        while let Some(mut writer) = group.next_column()? {
            let values = some.iter().map(|row| row[number]);
            if columns[number].whole {
                let values: Vec<i64> = values.map(|value| value as i64).collect();
                writer.typed::<Int64Type>().write_batch(&values, None, None)?;
            } else {
                writer.typed::<DoubleType>().write_batch(&values.collect::<Vec<f64>>(), None, None)?;
            }
            writer.close()?;
            number += 1;
        }
        group.close()?;
    }
    file.close().map(drop)
}

/// Gives the first rows of such a file to a sink.
///
/// # Errors
/// The errors of the file and of the sink, and [`ErrorKind::InvalidData`] if the file is not a table of numbers with these names.
pub(crate) fn read(
    path: &Path,
    names: &[String],
    rows: u64,
    mut sink: impl FnMut(&[f64]) -> Result<(), Error>,
) -> Result<(), Error> {
    let invalid = |error: ParquetError| Error::new(ErrorKind::InvalidData, error);
    let file = SerializedFileReader::new(File::open(path)?).map_err(invalid)?;
    let schema = file.metadata().file_metadata().schema_descr();
    let known = |column: &ColumnDescriptor| (column.name().to_owned(), column.physical_type());
    let expected = names.iter().map(|name| (name.clone(), Physical::DOUBLE));
    if !expected.eq(schema.columns().iter().map(|column| known(column))) {
        return Err(Error::new(ErrorKind::InvalidData, "the file has other columns"));
    }
    let mut left = rows;
    for group in 0..file.num_row_groups() {
        let group = file.get_row_group(group).map_err(invalid)?;
        let count = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        let mut columns = Vec::new();
        for column in 0..names.len() {
            let reader = group.get_column_reader(column).map_err(invalid)?;
            let mut values = Vec::with_capacity(count);
            get_typed_column_reader::<DoubleType>(reader)
                .read_records(count, None, None, &mut values)
                .map_err(invalid)?;
            columns.push(values);
        }
        for row in 0..count {
            if left == 0 {
                return Ok(());
            }
            let numbers: Option<Vec<f64>> = columns.iter().map(|values| values.get(row).copied()).collect();
            sink(&numbers.ok_or_else(|| Error::new(ErrorKind::InvalidData, "a column is too short"))?)?;
            left -= 1;
        }
    }
    Ok(())
}
