use super::lines::{Damage, Lines, parsed};
use super::result::{self, Shape};
use crate::error::CliError;
use crate::files::{check_file, write_whole};
use crate::output::metadata_of;
use crate::part::Part;
use crate::terminal;
use std::io::{BufRead, BufReader, Error, ErrorKind, Seek, SeekFrom, Write};
use std::path::Path;

/// Rows on their way: a file beside the result, to which every row is added when its member is done, and from which the result is made
/// at the end. So the memory holds few of them, and what an interrupted run has done is not lost.
pub(super) struct Spool {
    part: Part,
    lines: Lines,
    /// How many are in it: those of the members from 0 on.
    rows: u64,
    /// Its first line.
    header: String,
}

/// What is to be done with what is there.
#[derive(Clone, Copy)]
pub(super) struct Asked {
    /// Go on from the rows of an interrupted run.
    pub(super) resume: bool,
    /// Overwrite them, and the result.
    pub(super) force: bool,
}

impl Spool {
    /// The spool of a sweep with that identity and so many members, whose rows have so many numbers; `seen` receives the values and the
    /// error of every row that is taken over.
    pub(super) fn open(
        out: &Path,
        (identity, members, numbers): (&str, u64, usize),
        asked: Asked,
        seen: impl FnMut(&[f64], Option<&str>),
    ) -> Result<Self, CliError> {
        let part = Part::lock(out)?;
        let found = part.file().metadata().map_err(|source| part.failed(source))?.len();
        // Whoever had the lock may have written the result meanwhile.
        if let Err(error) = check_file(out, asked.force) {
            if found == 0 {
                part.remove();
            }
            return Err(error);
        }
        let (lines, header) = (Lines::new(identity, numbers), format!("{identity}\n"));
        let mut spool = Self { part, lines, rows: 0, header };
        let begun = found >= spool.header.len() as u64 || !spool.has_begun_only(found)?;
        if begun && asked.resume {
            spool.take_over(members, seen)?;
        } else if begun && !asked.force {
            return Err(CliError::Request(format!(
                "{} is there, of an interrupted run; --resume goes on, --force begins anew",
                spool.part.path().display()
            )));
        } else {
            spool.begin().map_err(|source| spool.part.failed(source))?;
        }
        Ok(spool)
    }

    /// How many rows are in it.
    pub(super) fn rows(&self) -> u64 {
        self.rows
    }

    /// The format of its lines.
    pub(super) fn lines(&self) -> &Lines {
        &self.lines
    }

    /// Whether there is only a beginning of the first line: a process was ended while it wrote that.
    fn has_begun_only(&self, size: u64) -> Result<bool, CliError> {
        let mut text = Vec::new();
        let mut reader = self.reader().map_err(|source| self.part.failed(source))?;
        reader.read_until(b'\n', &mut text).map_err(|source| self.part.failed(source))?;
        Ok(text.len() as u64 == size && self.header.as_bytes().starts_with(&text))
    }

    fn begin(&mut self) -> Result<(), Error> {
        let mut file = self.part.file();
        file.set_len(0)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(self.header.as_bytes())
    }

    fn reader(&self) -> Result<BufReader<&std::fs::File>, Error> {
        let mut file = self.part.file();
        file.seek(SeekFrom::Start(0))?;
        Ok(BufReader::with_capacity(1 << 16, file))
    }

    /// Keeps the rows that are whole and in order; the first that is not, and all after it, are made again.
    fn take_over(&mut self, members: u64, mut seen: impl FnMut(&[f64], Option<&str>)) -> Result<(), CliError> {
        let unreadable = |source| CliError::Read { path: self.part.path().to_owned(), source };
        let (mut reader, mut line) = (self.reader().map_err(unreadable)?, Vec::new());
        reader.read_until(b'\n', &mut line).map_err(unreadable)?;
        if line != self.header.as_bytes() {
            return Err(CliError::Request(format!(
                "{}:1: belongs to another sweep or another version of the program, or is damaged; without --resume, --force begins anew",
                self.part.path().display()
            )));
        }
        let (mut whole, mut rows) = (line.len() as u64, 0);
        let damage = loop {
            line.clear();
            if reader.read_until(b'\n', &mut line).map_err(unreadable)? == 0 {
                break None;
            }
            let text = match self.lines.row(&line, rows) {
                Ok(text) if rows < members => text,
                Ok(_) => break Some(Damage::Member(rows.to_string())),
                Err(damage) => break Some(damage),
            };
            let (values, error) = parsed(text);
            seen(&values, error.as_deref());
            (whole, rows) = (whole + line.len() as u64, rows + 1);
        };
        drop(reader);
        // A row that was being written when the program ended has no end; that is no news.
        if let Some(damage) = damage.filter(|damage| *damage != Damage::Cut) {
            let (path, number) = (self.part.path().display(), rows + 2);
            let told = format!("{path}:{number}: damaged: {damage}; the members from {rows} on are made again");
            terminal::say("warning", &told);
        }
        let mut file = self.part.file();
        file.set_len(whole).and_then(|()| file.seek(SeekFrom::End(0))).map_err(|source| self.part.failed(source))?;
        self.rows = rows;
        Ok(())
    }

    /// Adds so many rows, as [`Lines::line`] made them; they are with the operating system when this returns.
    pub(super) fn add(&mut self, text: &str, rows: u64) -> Result<(), CliError> {
        self.rows += rows;
        let mut file = self.part.file();
        file.write_all(text.as_bytes()).map_err(|source| self.part.failed(source))
    }

    /// Makes the result of the rows 0 to `members - 1`, each of which must be there once; it appears whole or not at all. Then the
    /// file is removed.
    pub(super) fn finish(self, out: &Path, shape: &Shape<'_>, overwrite: bool) -> Result<(), CliError> {
        let rows = || self.whole_rows(shape.count);
        write_whole(out, overwrite, |file| result::write(file, shape, &rows))?;
        if shape.format.is_text() {
            write_whole(&metadata_of(out), true, |file| file.write_all(shape.metadata.as_bytes()))?;
        }
        self.part.remove();
        Ok(())
    }

    /// A reader of the rows, which fails where they are not those of the members in order.
    fn whole_rows(&self, members: u64) -> Result<Rows<'_>, Error> {
        let mut reader = self.reader()?;
        reader.skip_until(b'\n')?;
        Ok(Rows { spool: self, reader, line: Vec::new(), next: 0, members })
    }
}

/// Reads the rows of a spool, one after the other.
pub(super) struct Rows<'a> {
    spool: &'a Spool,
    reader: BufReader<&'a std::fs::File>,
    line: Vec<u8>,
    next: u64,
    members: u64,
}

impl Rows<'_> {
    /// The text of the next row; none after the last one.
    pub(super) fn next(&mut self) -> Result<Option<&str>, Error> {
        self.line.clear();
        let read = self.reader.read_until(b'\n', &mut self.line)?;
        if read == 0 && self.next == self.members {
            return Ok(None);
        }
        let row = self.spool.lines.row(&self.line, self.next);
        self.next += 1;
        match row {
            Ok(text) if self.next <= self.members => Ok(Some(text)),
            Ok(_) => Err(self.damaged(&Damage::Member((self.next - 1).to_string()))),
            Err(damage) => Err(self.damaged(&damage)),
        }
    }

    fn damaged(&self, damage: &Damage) -> Error {
        let path = self.spool.part.path().display();
        let problem =
            format!("{path}:{}: damaged: {damage}; --resume makes the members from there on again", self.next + 1);
        Error::new(ErrorKind::InvalidData, problem)
    }
}
