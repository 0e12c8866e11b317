use super::lines::{Damage, Lines};
use std::fs::File;
use std::io::{BufRead, BufReader, Error, ErrorKind, Seek, SeekFrom};
use std::ops::Range;
use std::path::PathBuf;

/// A file of rows: its first line is the identity of the sweep.
pub(super) enum Source {
    /// It is open already.
    Open(PathBuf, File),
    /// It is opened when it is read.
    At(PathBuf),
}

/// Reads the rows of some members, one after the other, from one file after the other.
pub(super) struct SpoolRows<'a> {
    lines: &'a Lines,
    header: &'a str,
    sources: std::vec::IntoIter<Source>,
    reading: Option<Reading>,
    line: Vec<u8>,
    next: u64,
    end: u64,
    advice: &'static str,
}

struct Reading {
    path: PathBuf,
    reader: BufReader<File>,
    /// The number of the line that was read last.
    number: u64,
}

impl<'a> SpoolRows<'a> {
    /// The rows of the members `members`, in the lines of `lines` after the first line `header`; `advice` says what to do if they are
    /// missing.
    pub(super) fn new(
        (lines, header): (&'a Lines, &'a str),
        sources: Vec<Source>,
        members: Range<u64>,
        advice: &'static str,
    ) -> Self {
        let (next, end) = (members.start, members.end);
        Self { lines, header, sources: sources.into_iter(), reading: None, line: Vec::new(), next, end, advice }
    }

    /// The text of the next row; `None` after the last one.
    pub(super) fn next(&mut self) -> Result<Option<&str>, Error> {
        loop {
            let Some(reading) = &mut self.reading else {
                let Some(source) = self.sources.next() else {
                    return if self.next == self.end { Ok(None) } else { Err(missing(self.next, self.advice)) };
                };
                self.open(source)?;
                continue;
            };
            self.line.clear();
            if reading.reader.read_until(b'\n', &mut self.line)? == 0 {
                self.reading = None;
                continue;
            }
            reading.number += 1;
            break;
        }
        let member = self.next;
        self.next += 1;
        match self.lines.row(&self.line, member) {
            Ok(_) if member >= self.end => Err(self.damaged(&Damage::Member(member.to_string()))),
            Ok(text) => Ok(Some(text)),
            Err(damage) => Err(self.damaged(&damage)),
        }
    }

    fn open(&mut self, source: Source) -> Result<(), Error> {
        let (path, file) = match source {
            Source::Open(path, mut file) => {
                file.seek(SeekFrom::Start(0))?;
                (path, file)
            }
            Source::At(path) => {
                let file = File::open(&path)?;
                (path, file)
            }
        };
        let mut reader = BufReader::with_capacity(1 << 16, file);
        self.line.clear();
        reader.read_until(b'\n', &mut self.line)?;
        self.reading = Some(Reading { path, reader, number: 1 });
        if self.line == self.header.as_bytes() { Ok(()) } else { Err(self.damaged(&Damage::Header)) }
    }

    fn damaged(&self, damage: &Damage) -> Error {
        let (path, number) =
            self.reading.as_ref().map_or((String::new(), 0), |of| (of.path.display().to_string(), of.number));
        Error::new(ErrorKind::InvalidData, format!("{path}:{number}: damaged: {damage}; {}", self.advice))
    }
}

fn missing(member: u64, advice: &str) -> Error {
    Error::new(ErrorKind::InvalidData, format!("the row of member {member} is missing; {advice}"))
}
