//! Files of points: comma-separated values with a header, of which a function of time takes two columns.

use crate::file;

/// Why there are no points.
pub(crate) enum Fault {
    /// The file cannot be read, or a value in it is not a number.
    File(String),
    /// The file has no column of this name.
    Column {
        /// The problem.
        problem: String,
        /// The columns of the file.
        known: String,
    },
}

/// The times and the values of the columns of these names in the file at `path`, seen from the folder of the scene at `origin`. A name
/// may leave the unit out that stands after the column's, as in `speed [m/s]`.
pub(crate) fn read(origin: &str, path: &str, names: [&str; 2]) -> Result<(Vec<f64>, Vec<f64>), Fault> {
    let text =
        file::text(&file::beside(origin, path)).map_err(|problem| Fault::File(format!("cannot be read: {problem}")))?;
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let broken = |error: csv::Error| Fault::File(format!("is not a table: {error}"));
    let header = reader.headers().map_err(broken)?.clone();
    let bare = |name: &str| name.split(" [").next().unwrap_or(name).to_owned();
    let column = |name: &str| {
        let place = header.iter().position(|known| known == name);
        place.or_else(|| header.iter().position(|known| bare(known) == name)).ok_or_else(|| Fault::Column {
            problem: format!("name `{}`, which the file does not have", name.escape_debug()),
            known: format!("two of {}", header.iter().map(|one| format!("`{one}`")).collect::<Vec<_>>().join(", ")),
        })
    };
    let columns = [column(names[0])?, column(names[1])?];
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |k: usize| {
            let text = record.get(k).unwrap_or_default();
            text.parse::<f64>().map_err(|_| Fault::File(format!("has no number in line {line}, but `{text}`")))
        };
        times.push(number(columns[0])?);
        values.push(number(columns[1])?);
    }
    Ok((times, values))
}
