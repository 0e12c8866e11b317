use super::members::MemberRow;
use crc32fast::Hasher;
use std::fmt::Write;

/// Format of a spool line: checksum, member number, numbers that read back exactly, and the error in quotes if there is one. The checksum
/// is seeded with the identity of the sweep, so that a line of another sweep does not match.
#[derive(Debug, Clone)]
pub(super) struct Lines {
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
        Self { seed, numbers }
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

    /// Checks that a line is the row of `member`, and returns its text as the `.csv` has it.
    pub(super) fn row<'l>(&self, line: &'l [u8], member: u64) -> Result<&'l str, Damage> {
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
        if found == expected { Ok(text) } else { Err(Damage::Numbers { found, expected }) }
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
