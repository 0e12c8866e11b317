//! The rows of a sweep in its files: a line for each, and readers of them.

use super::members::MemberRow;
use crc32fast::Hasher;
use std::fmt::Write;
use std::fs::File;
use std::io::{BufRead, BufReader, Error, ErrorKind, Seek, SeekFrom};
use std::ops::Range;
use std::path::PathBuf;

/// Format of a spool line: checksum, member number, numbers that read back exactly, and the error in quotes if there is one. The checksum
/// is seeded with the identity of the sweep, so that a line of another sweep does not match.
#[derive(Debug, Clone)]
pub(super) struct Lines {
    /// The first line of a file.
    pub(super) header: String,
    seed: Hasher,
    numbers: usize,
}

/// Why a line is not the row that it should be.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Damage {
    /// The line has no end: the program was ended while it was written.
    Cut,
    /// The first line is not the identity of the sweep.
    Header,
    /// The checksum does not match the text.
    Checksum,
    /// The row belongs to another member of this sweep.
    Member(String),
    /// The row has the wrong count of numbers.
    Numbers { found: usize, expected: usize },
}

impl std::fmt::Display for Damage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Cut => write!(f, "the line does not end with a line break"),
            Self::Header => write!(f, "the first line belongs to another sweep or to another version of the program"),
            Self::Checksum => write!(f, "the checksum does not match the line"),
            Self::Member(found) => write!(f, "the row belongs to member {found}"),
            Self::Numbers { found, expected } => write!(f, "{expected} numbers expected, found {found}"),
        }
    }
}

impl Lines {
    /// Lines of the sweep `identity`, whose rows have `numbers` numbers, the member number included.
    pub(super) fn new(identity: &str, numbers: usize) -> Self {
        let mut seed = Hasher::new();
        seed.update(identity.as_bytes());
        Self { header: format!("{identity}\n"), seed, numbers }
    }

    fn checksum(&self, text: &str) -> String {
        let mut hasher = self.seed.clone();
        hasher.update(text.as_bytes());
        format!("{:08x}", hasher.finalize())
    }

    /// A row as a line.
    pub(super) fn line(&self, row: &MemberRow) -> String {
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
        format!("{} {text}\n", self.checksum(&text))
    }

    /// Checks that a line is the row of `member`, which is before `end`, and returns its text as the `.csv` has it.
    pub(super) fn row<'l>(&self, line: &'l [u8], member: u64, end: u64) -> Result<&'l str, Damage> {
        let line = line.strip_suffix(b"\n").ok_or(Damage::Cut)?;
        let (sum, text) = std::str::from_utf8(line).ok().and_then(|l| l.split_once(' ')).ok_or(Damage::Checksum)?;
        if sum != self.checksum(text) {
            return Err(Damage::Checksum);
        }
        let (number, _) = text.split_once(',').unwrap_or((text, ""));
        if number.parse() != Ok(member) {
            return Err(Damage::Member(number.to_owned()));
        }
        let found = numbers(text).0.split(',').count();
        let expected = self.numbers;
        match found == expected {
            true if member < end => Ok(text),
            true => Err(Damage::Member(member.to_string())),
            false => Err(Damage::Numbers { found, expected }),
        }
    }
}

/// The numbers of a row, and its error in quotes.
fn numbers(text: &str) -> (&str, Option<&str>) {
    match text.split_once(",\"") {
        Some((numbers, error)) => (numbers, Some(error)),
        None => (text.strip_suffix(',').unwrap_or(text), None),
    }
}

/// The values of a row, without the number of the member, and its error.
pub(super) fn parsed(text: &str) -> (Vec<f64>, Option<String>) {
    let (numbers, error) = numbers(text);
    let values = numbers.split(',').skip(1).map(|number| number.parse().unwrap_or(f64::NAN)).collect();
    (values, error.map(|error| error.strip_suffix('"').unwrap_or(error).replace("\"\"", "\"")))
}

/// All numbers of a row: the member number, its values, and last 1 if the member failed, else 0.
pub(super) fn numbers_of(text: &str) -> Vec<f64> {
    let (numbers, error) = numbers(text);
    let failed = f64::from(u8::from(error.is_some()));
    numbers.split(',').map(|number| number.parse().unwrap_or(f64::NAN)).chain([failed]).collect()
}

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
    /// The rows of the members `members`, in lines of `lines`; `advice` says what to do if they are
    /// missing.
    pub(super) fn new(lines: &'a Lines, sources: Vec<Source>, members: Range<u64>, advice: &'static str) -> Self {
        let (next, end) = (members.start, members.end);
        Self { lines, sources: sources.into_iter(), reading: None, line: Vec::new(), next, end, advice }
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
        self.lines.row(&self.line, member, self.end).map(Some).map_err(|damage| self.damaged(&damage))
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
        if self.line == self.lines.header.as_bytes() { Ok(()) } else { Err(self.damaged(&Damage::Header)) }
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
