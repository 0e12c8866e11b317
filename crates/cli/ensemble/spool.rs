use super::result::Shape;
use super::rows::{Damage, Lines, Source, SpoolRows};
use crate::error::CliError;
use crate::files::check_file;
use crate::lock::PartFile;
use crate::terminal;
use std::io::{BufRead, BufReader, Error, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::Path;

/// A file beside the result, to which every row is added when its member is done; the result is made from it at the end. So memory holds
/// few rows, and an interrupted run keeps its finished rows.
pub(super) struct Spool {
    part: PartFile,
    lines: Lines,
    /// The first member of the spool.
    first: u64,
    /// The first member whose row is still missing.
    next: u64,
}

/// How to treat the rows of an interrupted run.
#[derive(Clone, Copy)]
pub(super) struct SpoolRequest {
    /// Continue from them.
    pub(super) resume: bool,
    /// Overwrite them and the result.
    pub(super) force: bool,
}

impl Spool {
    /// Opens the spool for `members` of the sweep `identity`, whose rows have `numbers` numbers. `seen` receives every row that is taken
    /// over.
    pub(super) fn open(
        out: &Path,
        (identity, members, numbers): (&str, Range<u64>, usize),
        asked: SpoolRequest,
        seen: impl FnMut(&str),
    ) -> Result<Self, CliError> {
        let part = PartFile::lock(out)?;
        let found = part.len()?;
        // Another process may have written the result meanwhile. If it was ended before it removed the spool, both files exist.
        if let Err(error) = check_file(out, asked.force || asked.resume && found > 0) {
            if found == 0 {
                part.remove();
            }
            return Err(error);
        }
        let lines = Lines::new(identity, numbers);
        let mut spool = Self { part, lines, first: members.start, next: members.start };
        let begun = found >= spool.lines.header.len() as u64 || !spool.has_begun_only(found)?;
        if begun && asked.resume {
            spool.take_over(members.end, seen)?;
            if spool.next < members.end {
                check_file(out, asked.force)?;
            }
        } else if begun && !asked.force {
            return Err(CliError::Request(format!(
                "{} has the rows of an interrupted run; --resume continues the run, --force begins anew",
                spool.part.path().display()
            )));
        } else {
            spool.begin().map_err(|source| spool.part.failed(source))?;
        }
        Ok(spool)
    }

    /// The first member whose row is still missing.
    pub(super) fn next(&self) -> u64 {
        self.next
    }

    /// The format of its lines.
    pub(super) fn lines(&self) -> &Lines {
        &self.lines
    }

    /// Whether the file holds only the beginning of the header: a process was ended while it wrote the header.
    fn has_begun_only(&self, size: u64) -> Result<bool, CliError> {
        let mut text = Vec::new();
        let mut reader = self.reader().map_err(|source| self.part.failed(source))?;
        reader.read_until(b'\n', &mut text).map_err(|source| self.part.failed(source))?;
        Ok(text.len() as u64 == size && self.lines.header.as_bytes().starts_with(&text))
    }

    fn begin(&mut self) -> Result<(), Error> {
        let mut file = self.part.file();
        file.set_len(0)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(self.lines.header.as_bytes())
    }

    fn reader(&self) -> Result<BufReader<&std::fs::File>, Error> {
        let mut file = self.part.file();
        file.seek(SeekFrom::Start(0))?;
        Ok(BufReader::with_capacity(1 << 16, file))
    }

    /// Keeps the leading rows that are whole and in order; all later rows are computed again.
    fn take_over(&mut self, members: u64, mut seen: impl FnMut(&str)) -> Result<(), CliError> {
        let unreadable = |source| CliError::Read { path: self.part.path().to_owned(), source };
        let (mut reader, mut line) = (self.reader().map_err(unreadable)?, Vec::new());
        reader.read_until(b'\n', &mut line).map_err(unreadable)?;
        if line != self.lines.header.as_bytes() {
            let (found, own) = (String::from_utf8_lossy(&line[..line.len().min(200)]), self.lines.header.trim_end());
            return Err(CliError::Request(format!(
                "{}:1: the file belongs to another sweep or to another version of the program, or is damaged: it begins with `{}`, and the rows \
                    of this sweep begin with `{own}`; without --resume, --force begins anew",
                self.part.path().display(),
                found.trim_end()
            )));
        }
        let (mut whole, mut rows) = (line.len() as u64, self.first);
        let damage = loop {
            line.clear();
            if reader.read_until(b'\n', &mut line).map_err(unreadable)? == 0 {
                break None;
            }
            match self.lines.row(&line, rows, members) {
                Ok(text) => seen(text),
                Err(damage) => break Some(damage),
            }
            (whole, rows) = (whole + line.len() as u64, rows + 1);
        };
        drop(reader);
        // A row that was being written when the program ended has no end; that is no news.
        if let Some(damage) = damage.filter(|damage| *damage != Damage::Cut) {
            let (path, number) = (self.part.path().display(), rows - self.first + 2);
            let told = format!("{path}:{number}: damaged: {damage}; the members from number {rows} are computed again");
            terminal::say("warning", &told);
        }
        let mut file = self.part.file();
        file.set_len(whole).and_then(|()| file.seek(SeekFrom::End(0))).map_err(|source| self.part.failed(source))?;
        self.next = rows;
        Ok(())
    }

    /// Appends `rows` rows that [`Lines::line`] formatted; the operating system has them on return.
    pub(super) fn add(&mut self, text: &str, rows: u64) -> Result<(), CliError> {
        self.next += rows;
        let mut file = self.part.file();
        file.write_all(text.as_bytes()).map_err(|source| self.part.failed(source))
    }

    /// Makes the result of the rows 0 to `members - 1`, each of which must be there once; it appears whole or not at all. Then the
    /// file is removed.
    pub(super) fn finish(self, out: &Path, shape: &Shape<'_>, overwrite: bool) -> Result<(), CliError> {
        shape.write(out, overwrite, &|| self.whole_rows(shape.count))?;
        self.part.remove();
        Ok(())
    }

    /// Gives the file the name of a part of a sweep, if every row is there once.
    pub(super) fn becomes_part(self, out: &Path, members: u64) -> Result<(), CliError> {
        let unreadable = |source| CliError::Read { path: self.part.path().to_owned(), source };
        let mut rows = self.whole_rows(members).map_err(unreadable)?;
        while rows.next().map_err(unreadable)?.is_some() {}
        drop(rows);
        self.part.file().sync_all().map_err(|source| self.part.failed(source))?;
        self.part.becomes(out, true)
    }

    /// A reader of the rows; it fails if the rows do not belong to the members in order.
    fn whole_rows(&self, members: u64) -> Result<SpoolRows<'_>, Error> {
        let source = Source::Open(self.part.path().to_owned(), self.part.file().try_clone()?);
        let advice = "--resume computes the members from there again";
        Ok(SpoolRows::new(&self.lines, vec![source], self.first..members, advice))
    }
}
