use crate::error::CliError;
use crate::files::{check_file, write_whole};
use crate::format::{Format, csv_header};
use crate::lock::PartFile;
use crate::provenance::{Provenance, described, label, metadata_of};
use crate::{columns_file, terminal};
use crc32fast::Hasher;
use scene::Column;
use std::fs::File;
use std::io::{BufReader, BufWriter, Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Where the rows of a run are to be written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutputRequest<'a> {
    /// The file; `None` for standard output.
    pub(crate) path: Option<&'a Path>,
    format: Format,
    force: bool,
}

impl<'a> OutputRequest<'a> {
    /// Checks, before the work begins, that the rows can be written at the end. A resumed run may find its own file.
    pub(crate) fn new(path: &'a Path, format: Option<Format>, force: bool, resumed: bool) -> Result<Self, CliError> {
        if path == Path::new("-") {
            let format = format.unwrap_or(Format::Csv);
            if !format.is_text() {
                let problem = "--out -: standard output takes --format csv or jsonl; the other formats need a file";
                return Err(CliError::Request(problem.to_owned()));
            }
            return Ok(Self { path: None, format, force });
        }
        let format = Format::of(path, format)?;
        check_file(path, force || resumed)?;
        format.check_metadata(path, force || resumed)?;
        Ok(Self { path: Some(path), format, force })
    }
}

/// How far an output has come, as in a checkpoint: bytes, checksum, and stride of the nodes.
pub(crate) type Position = [u64; 3];

/// Rows of numbers on their way to a file or to standard output. Rows of text are written as they come; a file is written as `OUT.part`,
/// which gets its name at the end. For the binary formats `OUT.part` holds the numbers, and the output is made from it at the end.
pub(crate) struct Output<'a> {
    asked: OutputRequest<'a>,
    provenance: Provenance,
    columns: Vec<Column>,
    every: u64,
    part: Option<PartFile>,
    writer: BufWriter<Box<dyn Write>>,
    line: Vec<u8>,
    bytes: u64,
    checksum: Hasher,
    /// The position before the last row, if that row is off the stride and written only because the run ends.
    before_last: Option<Position>,
    failed: Option<Error>,
    /// True if the existing output belongs to this run and may be replaced.
    own: bool,
}

impl<'a> Output<'a> {
    /// Begins an output, or continues from a position; the flag beside it is false if the checkpoint is at the start of the run.
    pub(crate) fn open(
        asked: OutputRequest<'a>,
        provenance: Provenance,
        (columns, every): (Vec<Column>, u64),
        from: Option<(Position, bool)>,
    ) -> Result<Self, CliError> {
        let part = asked.path.map(PartFile::lock).transpose()?;
        let new = part.as_ref().filter(|part| part.is_new()).map(|part| part.path().to_owned());
        let writer: Box<dyn Write> = match &part {
            Some(part) => Box::new(part.file().try_clone().map_err(|source| part.failed(source))?),
            None => Box::new(terminal::Out),
        };
        let output = Self {
            asked,
            provenance,
            columns,
            every,
            part,
            writer: BufWriter::with_capacity(1 << 16, writer),
            line: Vec::new(),
            bytes: 0,
            checksum: Hasher::new(),
            before_last: None,
            failed: None,
            own: false,
        };
        output.begun(from).inspect_err(|_| {
            let _ = new.map(std::fs::remove_file);
        })
    }

    fn begun(mut self, from: Option<(Position, bool)>) -> Result<Self, CliError> {
        let asked = self.asked;
        if let (Some((position, begun)), Some(path)) = (from, asked.path)
            && self.goes_on(path, position, begun)?
        {
            return Ok(self);
        }
        if let (Some(part), Some(path)) = (&self.part, asked.path) {
            if !(asked.force || self.own) {
                check_file(path, false)?;
                if part.len()? > 0 {
                    return Err(CliError::Request(format!(
                        "{} has rows of a run that was ended; --resume CHECKPOINT continues that run, --force begins anew",
                        part.path().display()
                    )));
                }
            }
            let mut file = part.file();
            file.set_len(0).and_then(|()| file.seek(SeekFrom::Start(0))).map_err(|source| part.failed(source))?;
        }
        if asked.format == Format::Csv {
            self.line = format!("{}\n", csv_header(self.columns.iter().map(label))).into_bytes();
            self.write();
        }
        Ok(self)
    }

    /// Takes over the rows up to a position, from `OUT.part` or from the output of an ended run. Returns false if neither has them. If the
    /// run has not begun, the rows only show whether the output is its own.
    fn goes_on(&mut self, path: &Path, [bytes, checksum, every]: Position, begun: bool) -> Result<bool, CliError> {
        let Some(part) = &self.part else { return Ok(false) };
        let unreadable = |source| CliError::Read { path: part.path().to_owned(), source };
        let mut file = part.file();
        let there = part.len()?;
        let same = |sum: &Hasher| u64::from(sum.clone().finalize()) == checksum;
        let mut found = summed(file, bytes).map_err(unreadable)?.filter(same);
        let old = File::open(path).is_ok();
        let in_old = old && found.is_none() && {
            let mut sum = Summed(Hasher::new());
            match self.old_rows(path, bytes, &mut sum) {
                Ok(()) => same(&sum.0),
                Err(error) if error.kind() == ErrorKind::InvalidData => false,
                Err(source) => return Err(CliError::Read { path: path.to_owned(), source }),
            }
        };
        if !begun {
            self.own = bytes > 0 && (in_old || found.is_some());
            return Ok(false);
        }
        if in_old {
            if there > 0 && !self.asked.force {
                return Err(CliError::Request(format!(
                    "{} has other rows than {}, which has those from before the checkpoint; --force continues the latter",
                    part.path().display(),
                    path.display()
                )));
            }
            let mut writer = BufWriter::with_capacity(1 << 16, file);
            let emptied = file.set_len(0).and_then(|()| file.seek(SeekFrom::Start(0)));
            let copied = emptied.and_then(|_| self.old_rows(path, bytes, &mut writer)).and_then(|()| writer.flush());
            copied.map_err(|source| part.failed(source))?;
            found = summed(file, bytes).map_err(unreadable)?.filter(same);
        }
        match found {
            Some(_) if every != self.every => Err(CliError::Request(format!(
                "--every {}: the rows before the checkpoint were written with --every {every}",
                self.every
            ))),
            Some(sum) => {
                file.set_len(bytes).and_then(|()| file.seek(SeekFrom::End(0))).map_err(unreadable)?;
                (self.bytes, self.checksum, self.own) = (bytes, sum, true);
                Ok(true)
            }
            None if self.asked.force || part.is_new() && !old => {
                let told = "no rows from before the checkpoint are left; the file begins after the checkpoint";
                terminal::say("warning", &format!("{}: {told}", path.display()));
                Ok(false)
            }
            None => Err(CliError::Request(format!(
                "{}: neither this file nor {} begins with the rows from before the checkpoint; --force begins a new \
                    file after the checkpoint",
                path.display(),
                part.path().display()
            ))),
        }
    }

    /// Writes the rows at the beginning of a finished output as they were in `OUT.part`: `bytes` bytes.
    ///
    /// # Errors
    /// The errors of the files, and [`ErrorKind::InvalidData`] if the output has no such rows.
    fn old_rows(&self, path: &Path, bytes: u64, to: &mut impl Write) -> Result<(), Error> {
        if self.asked.format.is_text() {
            let copied = std::io::copy(&mut File::open(path)?.take(bytes), to)?;
            return if copied == bytes { Ok(()) } else { Err(ErrorKind::InvalidData.into()) };
        }
        let rows = bytes.checked_div(8 * self.columns.len() as u64).ok_or(ErrorKind::InvalidData)?;
        columns_file::copy_rows(path, self.asked.format, &self.columns, rows, to)
    }

    /// Adds the row of node `k`. An error is kept until the end: the run goes on.
    pub(crate) fn row(&mut self, k: u64, row: &[f64]) {
        // A node off the stride is the last one of an ended run; the resumed run does not have it.
        self.before_last = (!k.is_multiple_of(self.every)).then(|| self.here());
        self.line.clear();
        match self.asked.format {
            Format::Csv => {
                for (i, value) in row.iter().enumerate() {
                    let comma = if i > 0 { "," } else { "" };
                    // `{:?}` prints the shortest text that reads back as the same number. Writing to memory cannot fail.
                    let _ = write!(self.line, "{comma}{value:?}");
                }
                self.line.push(b'\n');
            }
            Format::Jsonl => {
                for (i, (column, value)) in self.columns.iter().zip(row).enumerate() {
                    let comma = if i > 0 { "," } else { "{" };
                    let name = serde_json::Value::from(column.name.as_str());
                    let _ = match value.is_finite() {
                        true => write!(self.line, "{comma}{name}:{value:?}"),
                        false => write!(self.line, "{comma}{name}:null"),
                    };
                }
                self.line.extend(b"}\n");
            }
            _ => self.line.extend(row.iter().flat_map(|value| value.to_le_bytes())),
        }
        self.write();
    }

    fn write(&mut self) {
        if self.failed.is_none() {
            self.checksum.update(&self.line);
            self.bytes += self.line.len() as u64;
            self.failed = self.writer.write_all(&self.line).err();
        }
    }

    /// Whether the reader has closed the output.
    pub(crate) fn is_closed(&self) -> bool {
        self.failed.as_ref().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
    }

    /// Flushes and syncs the rows written, and returns their byte count, checksum and stride. A final row off the stride is excluded.
    pub(crate) fn position(&mut self) -> Option<Position> {
        if self.failed.is_some() {
            return None;
        }
        let kept = self.writer.flush().and_then(|()| self.part.as_ref().map_or(Ok(()), |part| part.file().sync_data()));
        self.failed = kept.err();
        let kept = self.part.is_some() && self.failed.is_none();
        kept.then(|| self.before_last.unwrap_or_else(|| self.here()))
    }

    fn here(&self) -> Position {
        [self.bytes, u64::from(self.checksum.clone().finalize()), self.every]
    }

    /// Ends the output: a file appears whole, or not at all. A run with a checkpoint keeps what resuming needs. Without one, nothing is
    /// left if the file cannot be written.
    pub(crate) fn finish(self, checkpoint: bool, interrupted: bool) -> Result<(), CliError> {
        let beside = self.part.as_ref().map(|part| part.path().to_owned());
        let outcome = self.written(checkpoint, interrupted);
        if let (Err(CliError::Write { .. } | CliError::Folder { .. }), Some(beside), false) =
            (&outcome, beside, checkpoint)
        {
            let _ = std::fs::remove_file(beside);
        }
        outcome
    }

    fn written(mut self, checkpoint: bool, interrupted: bool) -> Result<(), CliError> {
        let flushed = self.writer.flush();
        let failed = self.failed.take().map_or(flushed, Err);
        let (Some(path), Some(part)) = (self.asked.path, self.part) else {
            return match failed {
                Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(error)),
                _ => Ok(()),
            };
        };
        failed.map_err(|source| part.failed(source))?;
        let overwrite = self.asked.force || self.own;
        let provenance = self.provenance.interrupted(interrupted.then_some("a signal ended the run"));
        if self.asked.format.is_text() {
            part.file().sync_all().map_err(|source| part.failed(source))?;
            // The metadata comes first, so that rows never lack it.
            check_file(path, overwrite)?;
            provenance.write_beside(path, &described(&self.columns))?;
            return part.becomes(path, overwrite).inspect_err(|_| {
                let _ = std::fs::remove_file(metadata_of(path));
            });
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let document = provenance.document(&name, &described(&self.columns));
        let width = 8 * self.columns.len();
        let rows = self.bytes.checked_div(width as u64).unwrap_or(0);
        write_whole(path, overwrite, |file| {
            self.asked.format.write_numbers(file, &self.columns, (rows, &document), numbers(part.file(), width)?)
        })?;
        // Rows that a run goes on from are kept.
        if !(checkpoint && interrupted) {
            part.remove();
        }
        Ok(())
    }
}

/// Sums the bytes written into a checksum.
struct Summed(Hasher);

impl Write for Summed {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Error> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Error> {
        Ok(())
    }
}

/// The checksum of the first `bytes` bytes of a file; `None` if the file is shorter.
fn summed(mut file: &File, bytes: u64) -> Result<Option<Hasher>, Error> {
    file.seek(SeekFrom::Start(0))?;
    let mut sum = Summed(Hasher::new());
    let found = std::io::copy(&mut BufReader::with_capacity(1 << 16, file).take(bytes), &mut sum)?;
    Ok((found == bytes).then_some(sum.0))
}

/// The rows of numbers in a file, from its beginning.
fn numbers(mut file: &File, width: usize) -> Result<impl Iterator<Item = Result<Vec<f64>, Error>>, Error> {
    file.seek(SeekFrom::Start(0))?;
    let (mut reader, mut bytes) = (BufReader::with_capacity(1 << 16, file), vec![0; width]);
    Ok(std::iter::from_fn(move || match reader.read_exact(&mut bytes) {
        Ok(()) => Some(Ok(bytes.as_chunks().0.iter().map(|number| f64::from_le_bytes(*number)).collect())),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => None,
        Err(error) => Some(Err(error)),
    }))
}
