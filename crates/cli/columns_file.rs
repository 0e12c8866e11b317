//! Reads a file of columns of numbers back: .csv or .npz.

use crate::error::CliError;
use crate::provenance::named;
use std::fs::File;
use std::io::{Error, ErrorKind};
use std::path::Path;

/// A column of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NamedColumn {
    pub(crate) name: String,
    /// Where the file says it.
    pub(crate) unit: Option<String>,
    pub(crate) values: Vec<f64>,
}

impl NamedColumn {
    /// From a heading `name [unit]`, or `name`.
    pub(crate) fn headed(heading: &str, values: Vec<f64>) -> Self {
        let (name, unit) = named(heading);
        Self { name: name.to_owned(), unit: unit.map(str::to_owned), values }
    }
}

/// The columns of a file; a column of texts is not among them.
pub(crate) type Columns = Vec<NamedColumn>;

/// Reads a file, by the ending of its name.
pub(crate) fn read(path: &Path) -> Result<Columns, CliError> {
    let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
    // A device might never end.
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        let source = Error::new(ErrorKind::InvalidInput, "the path is not a regular file");
        return Err(CliError::Read { path: path.to_owned(), source });
    }
    let columns = match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("csv") => csv(path),
        Some("npz") => npz(path),
        _ => {
            let problem = "accepted is a file .csv or .npz, by the ending of its name";
            return Err(CliError::Request(format!("{}: {problem}", path.display())));
        }
    };
    columns.map_err(|source| CliError::Read { path: path.to_owned(), source })
}

/// The columns all of whose fields are numbers. Names lose their units, so that the formats have the same.
fn csv(path: &Path) -> Result<Columns, Error> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_path(path)?;
    let mut columns: Vec<(NamedColumn, bool)> = Vec::new();
    for heading in reader.headers()? {
        let mut column = NamedColumn::headed(heading, Vec::new());
        let copies = columns.iter().filter(|(other, _)| other.name.split('.').next() == Some(&column.name)).count();
        // Two columns of one name are told apart, as pandas does it.
        if copies > 0 {
            column.name += &format!(".{copies}");
        }
        columns.push((column, true));
    }
    for record in reader.records() {
        for (cell, (column, numbers)) in record?.iter().zip(&mut columns) {
            // An empty cell is a missing number.
            let number = if cell.is_empty() { Ok(f64::NAN) } else { cell.parse() };
            *numbers &= number.is_ok();
            column.values.push(number.unwrap_or(f64::NAN));
        }
    }
    Ok(columns.into_iter().filter(|(_, numbers)| *numbers).map(|(column, _)| column).collect())
}

fn npz(path: &Path) -> Result<Columns, Error> {
    let invalid = |error: zip::result::ZipError| Error::new(ErrorKind::InvalidData, error);
    let mut archive = zip::ZipArchive::new(File::open(path)?).map_err(invalid)?;
    let mut columns = Vec::new();
    for number in 0..archive.len() {
        let file = archive.by_index(number).map_err(invalid)?;
        let name = file.name().map_err(invalid)?.into_owned();
        let Some(name) = npyz::npz::array_name_from_file_name(&name).map(str::to_owned) else { continue };
        let array = npyz::NpyFile::new(file)?;
        // An array of texts is not a column of numbers.
        let values: Option<Vec<f64>> = match array.try_data::<f64>() {
            Ok(numbers) => Some(numbers.collect::<Result<_, _>>()?),
            Err(array) => {
                array.into_vec::<i64>().ok().map(|whole| whole.into_iter().map(|number| number as f64).collect())
            }
        };
        columns.extend(values.map(|values| NamedColumn { name, unit: None, values }));
    }
    Ok(columns)
}
