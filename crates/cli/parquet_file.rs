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
    let field = |name: String| {
        let field = Type::primitive_type_builder(&name, Physical::DOUBLE).with_repetition(Repetition::REQUIRED);
        field.build().map(Arc::new)
    };
    let fields = columns.names().map(field).collect::<Result<_, _>>()?;
    let schema = Type::group_type_builder("trajectory").with_fields(fields).build()?;
    // Hardly any number of a trajectory comes twice.
    let properties = WriterProperties::builder().set_dictionary_enabled(false).build();
    let mut file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    let mut column = 0;
    while let Some(mut writer) = group.next_column()? {
        let values: Vec<f64> = columns.rows.iter().map(|row| row[column]).collect();
        writer.typed::<DoubleType>().write_batch(&values, None, None)?;
        writer.close()?;
        column += 1;
    }
    group.close()?;
    file.close().map(drop)
}
