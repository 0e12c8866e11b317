use crate::error::CliError;
use crate::files::write_whole;
use crate::first_error::FirstError;
use scene::{Column, SceneSystem};
use std::io::{Error, Seek, Write};
use std::path::Path;

/// The formats a trajectory is written in.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Format {
    Csv,
    Npz,
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    /// By the ending of the file's name.
    pub(crate) fn of(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("csv") => Ok(Self::Csv),
            Some("npz") => Ok(Self::Npz),
            #[cfg(feature = "parquet")]
            Some("parquet") => Ok(Self::Parquet),
            #[cfg(not(feature = "parquet"))]
            Some("parquet") => Err(CliError::WithoutParquet { path: path.to_owned() }),
            _ => Err(CliError::Ending { path: path.to_owned() }),
        }
    }
}

/// A table of numbers, with a header.
pub(crate) struct Columns {
    header: Vec<Column>,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Columns {
    /// Names with their units, and rows of as many numbers.
    pub(crate) fn new(header: Vec<Column>, rows: Vec<Vec<f64>>) -> Self {
        Self { header, rows }
    }

    /// A trajectory in the words of a scene: what the scene does not have has no column.
    pub(crate) fn of<const N: usize, const M: usize>(
        system: &dyn SceneSystem<N, M>,
        nodes: &[dla::Node<N, M>],
    ) -> Self {
        let header = nodes.first().map_or_else(Vec::new, |first| system.columns(first));
        Self { header, rows: nodes.iter().map(|node| system.row(node)).collect() }
    }

    /// The columns, and the numbers of each.
    pub(crate) fn by_column(self) -> (Vec<Column>, Vec<Vec<f64>>) {
        let column = |k: usize| self.rows.iter().map(|row| row[k]).collect();
        let numbers = (0..self.header.len()).map(column).collect();
        (self.header, numbers)
    }

    /// The names of the columns, each with its unit.
    pub(crate) fn names(&self) -> impl Iterator<Item = String> {
        let whole = |name: &str, unit: &str| if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") };
        self.header.iter().map(move |Column { name, unit }| whole(name, unit))
    }
}

/// The most nodes that a file holds: those of a run are in memory, at about 100 bytes each, before they are written.
const MOST_NODES: u64 = 10_000_000;

/// Refuses, before a run begins, one of which more nodes would be kept than fit in the memory.
pub(crate) fn check_size(steps: u64, every: u64) -> Result<(), CliError> {
    // The first, every `every`-th, and the last, which may be one of those.
    let nodes = |every: u64| 1 + steps.div_ceil(every);
    if nodes(every) <= MOST_NODES {
        return Ok(());
    }
    Err(CliError::TooManyNodes { nodes: nodes(every), most: MOST_NODES, every: steps.div_ceil(MOST_NODES - 1) })
}

/// Writes a trajectory in the words of a scene: a file that appears whole or not at all.
pub(crate) fn write<const N: usize, const M: usize>(
    system: &dyn SceneSystem<N, M>,
    nodes: &[dla::Node<N, M>],
    path: &Path,
    format: Format,
    overwrite: bool,
) -> Result<(), CliError> {
    write_columns(&Columns::of(system, nodes), path, format, overwrite)
}

/// The same of any columns.
pub(crate) fn write_columns(columns: &Columns, path: &Path, format: Format, overwrite: bool) -> Result<(), CliError> {
    write_whole(path, overwrite, |file| match format {
        Format::Csv => csv(file, columns),
        Format::Npz => {
            let mut file = FirstError::new(file);
            let outcome = npz(&mut file, columns);
            // What stopped the file is the reason of whatever the archive then stumbled over.
            file.into_result().and(outcome)
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => crate::parquet_file::write(file, columns),
    })
}

fn csv(file: &mut impl Write, columns: &Columns) -> Result<(), Error> {
    let names: Vec<String> = columns.names().collect();
    writeln!(file, "{}", names.join(","))?;
    for row in &columns.rows {
        // `{:?}` prints the shortest text that reads back as the same number.
        write!(file, "{:?}", row[0])?;
        for value in &row[1..] {
            write!(file, ",{value:?}")?;
        }
        writeln!(file)?;
    }
    Ok(())
}

fn npz(file: &mut (impl Write + Seek), columns: &Columns) -> Result<(), Error> {
    use npyz::WriterBuilder;
    let mut archive = zip::ZipWriter::new(file);
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored).large_file(true);
    for (column, Column { name, .. }) in columns.header.iter().enumerate() {
        archive.start_file(npyz::npz::file_name_from_array_name(name), options)?;
        let mut array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[columns.rows.len() as u64])
            .writer(&mut archive)
            .begin_nd()?;
        array.extend(columns.rows.iter().map(|row| row[column]))?;
        array.finish()?;
    }
    archive.finish()?;
    Ok(())
}
