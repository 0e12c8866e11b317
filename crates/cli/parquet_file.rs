use crate::trajectory_file::Columns;
use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io::{Error, Write};
use std::sync::Arc;

/// Writes a trajectory as a Parquet file: one row group, one column of doubles for each of the `.csv`, of the same name.
pub(crate) fn write(file: &mut (impl Write + Send), columns: &Columns) -> Result<(), Error> {
    write_columns(file, columns).map_err(Error::other)
}

fn write_columns(file: &mut (impl Write + Send), columns: &Columns) -> Result<(), ParquetError> {
    write_table(
        file,
        columns.names().collect(),
        columns.rows.iter().map(|row| Ok(row.clone())),
        columns.rows.len().max(1),
    )
}

/// The rows of a group.
const GROUP: usize = 1 << 16;

/// Writes a table of numbers with these names, whose rows need not be in memory all at once.
pub(crate) fn write_groups(
    file: &mut (impl Write + Send),
    names: Vec<String>,
    rows: impl Iterator<Item = Result<Vec<f64>, Error>>,
) -> Result<(), Error> {
    write_table(file, names, rows, GROUP).map_err(Error::other)
}

fn write_table(
    file: &mut (impl Write + Send),
    names: Vec<String>,
    mut rows: impl Iterator<Item = Result<Vec<f64>, Error>>,
    size: usize,
) -> Result<(), ParquetError> {
    let field = |name: String| {
        let field = Type::primitive_type_builder(&name, Physical::DOUBLE).with_repetition(Repetition::REQUIRED);
        field.build().map(Arc::new)
    };
    let fields = names.into_iter().map(field).collect::<Result<_, _>>()?;
    let schema = Type::group_type_builder("trajectory").with_fields(fields).build()?;
    // Hardly any number of a trajectory comes twice.
    let properties = WriterProperties::builder().set_dictionary_enabled(false).build();
    let mut file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    loop {
        let some = rows.by_ref().take(size).collect::<Result<Vec<_>, Error>>()?;
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
