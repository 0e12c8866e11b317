use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io::{Error, Write};
use std::sync::Arc;

/// The rows of a group.
const GROUP: usize = 1 << 16;

/// Writes a table of numbers with these names, whose rows need not be in memory all at once; `metadata` is the value of the key `noslip`.
pub(crate) fn write(
    file: &mut (impl Write + Send),
    names: Vec<String>,
    metadata: &str,
    rows: impl Iterator<Item = Result<Vec<f64>, Error>>,
) -> Result<(), Error> {
    write_table(file, names, metadata, rows).map_err(Error::other)
}

fn write_table(
    file: &mut (impl Write + Send),
    names: Vec<String>,
    metadata: &str,
    mut rows: impl Iterator<Item = Result<Vec<f64>, Error>>,
) -> Result<(), ParquetError> {
    let field = |name: String| {
        let field = Type::primitive_type_builder(&name, Physical::DOUBLE).with_repetition(Repetition::REQUIRED);
        field.build().map(Arc::new)
    };
    let fields = names.into_iter().map(field).collect::<Result<_, _>>()?;
    let schema = Type::group_type_builder("trajectory").with_fields(fields).build()?;
    // Hardly any number of a trajectory comes twice.
    let pairs = vec![KeyValue::new("noslip".to_owned(), metadata.to_owned())];
    let properties =
        WriterProperties::builder().set_dictionary_enabled(false).set_key_value_metadata(Some(pairs)).build();
    let mut file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    loop {
        let some = rows.by_ref().take(GROUP).collect::<Result<Vec<_>, Error>>()?;
        if some.is_empty() {
            break;
        }
        let mut group = file.next_row_group()?;
        let mut column = 0;
        while let Some(mut writer) = group.next_column()? {
            let values: Vec<f64> = some.iter().map(|row| row[column]).collect();
            writer.typed::<DoubleType>().write_batch(&values, None, None)?;
            writer.close()?;
            column += 1;
        }
        group.close()?;
    }
    file.close().map(drop)
}
