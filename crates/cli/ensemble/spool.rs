use super::members::Row;
use crate::error::CliError;
use crate::files::write_whole;
use crate::first_error::FirstError;
use crate::trajectory_file::Format;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, BufWriter, Error, ErrorKind, Seek, Write};
use std::path::{Path, PathBuf};

/// Rows on their way: a file beside the result, to which every row is added when its member is done, and from which the result
/// is made at the end. So the memory holds few of them, and what an interrupted run has done is not lost.
pub(super) struct Spool {
    path: PathBuf,
    file: BufWriter<File>,
}

impl Spool {
    /// The name of the file beside `out`.
    pub(super) fn path_of(out: &Path) -> PathBuf {
        let mut name = out.file_name().unwrap_or_default().to_owned();
        name.push(".part");
        out.with_file_name(name)
    }

    /// A new file, which belongs to the sweep with that identity.
    pub(super) fn begin(out: &Path, identity: &str) -> Result<Self, CliError> {
        let path = Self::path_of(out);
        let failed = |source| CliError::Write { path: path.clone(), source };
        let mut file = BufWriter::new(File::create(&path).map_err(failed)?);
        writeln!(file, "{identity}").map_err(failed)?;
        Ok(Self { path, file })
    }

    /// The file of an interrupted run of the same sweep; `seen` receives the numbers and the error of every row in it.
    pub(super) fn resume(
        out: &Path,
        identity: &str,
        mut seen: impl FnMut(&[f64], bool),
    ) -> Result<(Self, u64), CliError> {
        let path = Self::path_of(out);
        let unreadable = |source| CliError::Read { path: path.clone(), source };
        let mut reader = BufReader::new(File::open(&path).map_err(unreadable)?);
        let mut line = String::new();
        reader.read_line(&mut line).map_err(unreadable)?;
        if line.trim_end() != identity {
            return Err(CliError::Request(format!(
                "{}: belongs to another sweep; without --resume, --force begins anew",
                path.display()
            )));
        }
        let (mut whole, mut rows) = (line.len() as u64, 0);
        loop {
            line.clear();
            // A row that was being written when the program ended has no end.
            if reader.read_line(&mut line).map_err(unreadable)? == 0 || !line.ends_with('\n') {
                break;
            }
            let (numbers, failed) = parsed(&line).map_err(unreadable)?;
            seen(&numbers[1..], failed);
            (whole, rows) = (whole + line.len() as u64, rows + 1);
        }
        let failed = |source| CliError::Write { path: path.clone(), source };
        let mut file = OpenOptions::new().write(true).open(&path).map_err(failed)?;
        file.set_len(whole).and_then(|()| file.seek(std::io::SeekFrom::End(0)).map(drop)).map_err(failed)?;
        Ok((Self { path, file: BufWriter::new(file) }, rows))
    }

    /// Adds rows, as [`text`] made them.
    pub(super) fn add(&mut self, text: &str) -> Result<(), CliError> {
        self.file.write_all(text.as_bytes()).map_err(|source| CliError::Write { path: self.path.clone(), source })
    }

    /// Writes all to the disk.
    pub(super) fn flush(&mut self) -> Result<(), CliError> {
        self.file.flush().map_err(|source| CliError::Write { path: self.path.clone(), source })
    }

    /// Makes the result of the rows, which appears whole or not at all, and removes the file.
    pub(super) fn finish(
        mut self,
        out: &Path,
        format: Format,
        header: &[(String, &'static str)],
        rows: u64,
        overwrite: bool,
    ) -> Result<(), CliError> {
        self.flush()?;
        let lines = || -> Result<_, Error> {
            let mut reader = BufReader::new(File::open(&self.path)?);
            reader.skip_until(b'\n')?;
            Ok(reader)
        };
        write_whole(out, overwrite, |file| match format {
            Format::Csv => {
                let names: Vec<String> = header.iter().map(|(name, unit)| label(name, unit)).collect();
                writeln!(file, "{},error", names.join(","))?;
                std::io::copy(&mut lines()?, file).map(drop)
            }
            Format::Npz => {
                let mut file = FirstError::new(file);
                let outcome = npz(&mut file, header, rows, lines);
                file.into_result().and(outcome)
            }
            #[cfg(feature = "parquet")]
            Format::Parquet => {
                let names = header.iter().map(|(name, unit)| label(name, unit)).collect();
                let lines = lines()?.lines().map(|line| parsed(&line?).map(|(numbers, _)| numbers));
                crate::parquet_file::write_groups(file, names, lines)
            }
        })?;
        // The result is there; that something is left beside it does no harm.
        let _ = std::fs::remove_file(&self.path);
        Ok(())
    }
}

fn label(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// A row as a line: numbers that read back as the same ones, and the error in quotes.
pub(super) fn text(row: &Row) -> String {
    use std::fmt::Write;
    let mut text = row.member.to_string();
    for value in &row.values {
        // Writing to a string cannot fail.
        let _ = write!(text, ",{value:?}");
    }
    text.push(',');
    if let Some(error) = &row.error {
        let line = error.split_whitespace().collect::<Vec<_>>().join(" ").replace('"', "\"\"");
        let _ = write!(text, "\"{line}\"");
    }
    text.push('\n');
    text
}

/// The numbers of a line, and whether it has an error.
fn parsed(line: &str) -> Result<(Vec<f64>, bool), Error> {
    let (numbers, error) = match line.trim_end().split_once(",\"") {
        Some((numbers, _)) => (numbers, true),
        None => (line.trim_end().trim_end_matches(','), false),
    };
    let number = |text: &str| text.parse().map_err(|_| Error::new(ErrorKind::InvalidData, "a row that is none"));
    Ok((numbers.split(',').map(number).collect::<Result<_, _>>()?, error))
}

/// An archive with an array for each column, one after the other.
fn npz<R: BufRead>(
    file: &mut (impl Write + Seek),
    header: &[(String, &'static str)],
    rows: u64,
    lines: impl Fn() -> Result<R, Error>,
) -> Result<(), Error> {
    use npyz::WriterBuilder;
    let mut archive = zip::ZipWriter::new(file);
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored).large_file(true);
    let failed = header.len();
    let names = header.iter().map(|(name, _)| name.as_str()).chain(["failed"]);
    for (column, name) in names.enumerate() {
        archive.start_file(npyz::npz::file_name_from_array_name(name), options)?;
        let mut array = npyz::WriteOptions::new().default_dtype().shape(&[rows]).writer(&mut archive).begin_nd()?;
        for line in lines()?.lines() {
            let (numbers, error) = parsed(&line?)?;
            let value = if column == failed { f64::from(u8::from(error)) } else { numbers[column] };
            array.push(&value)?;
        }
        array.finish()?;
    }
    archive.finish()?;
    Ok(())
}
