use std::fmt::Write;
use thiserror::Error;

/// The complete state of a run, from which it goes on as if it had never stopped, to the last bit.
///
/// It names its run, and holds lists of numbers by name. Its text has every `f64` as its bits:
///
/// ```text
/// noslip checkpoint 4
/// method = dla
/// q: 3ff0000000000000 bfe0000000000000
/// end 9c1f4a6f0d2b7e35
/// ```
///
/// with, at its end, the FNV-1a hash of all before it, which shows a file that is cut or changed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checkpoint {
    identity: Vec<(String, String)>,
    values: Vec<(String, Vec<u64>)>,
}

/// Why a run cannot go on from a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CheckpointError {
    /// The text is not a checkpoint.
    #[error("the file is not a checkpoint, or is damaged: a checkpoint is a text that begins with `{HEADER}`")]
    NotOne,
    /// The checkpoint has another version of the format.
    #[error("the checkpoint has the format version {found}; this program reads version {VERSION}")]
    Version {
        /// The version found.
        found: String,
    },
    /// The checkpoint is cut or changed.
    #[error("the checkpoint is damaged: its text does not have its checksum")]
    Damaged,
    /// The checkpoint belongs to another run.
    #[error(
        "the checkpoint belongs to another run: in the checkpoint, `{what}` is `{found}`; in this run, `{what}` is `{expected}`"
    )]
    Other {
        /// The first item that differs.
        what: String,
        /// In the checkpoint.
        found: String,
        /// In the run.
        expected: String,
    },
    /// The checkpoint lacks numbers that the run needs.
    #[error("the checkpoint lacks the {count} numbers `{name}`, which the run needs")]
    Missing {
        /// Their name.
        name: String,
        /// How many.
        count: usize,
    },
}

const HEADER: &str = "noslip checkpoint";
const VERSION: &str = "5";

impl Checkpoint {
    /// A checkpoint of the run that these pairs of a name and a value identify.
    pub fn of<'a>(identity: impl IntoIterator<Item = (&'a str, String)>) -> Self {
        // One line each.
        let line = |(name, value): (&str, String)| (name.to_owned(), value.escape_debug().to_string());
        Self { identity: identity.into_iter().map(line).collect(), values: Vec::new() }
    }

    /// The same checkpoint, with one more pair that identifies its run.
    #[must_use]
    pub fn of_run_with(mut self, name: &str, value: &str) -> Self {
        self.identity.push((name.to_owned(), value.escape_debug().to_string()));
        self
    }

    /// Adds numbers under a name.
    pub fn put(&mut self, name: &str, values: &[f64]) {
        self.values.push((name.to_owned(), values.iter().map(|value| value.to_bits()).collect()));
    }

    /// Adds whole numbers under a name.
    pub fn put_counts(&mut self, name: &str, values: &[u64]) {
        self.values.push((name.to_owned(), values.to_vec()));
    }

    /// The numbers of a name, however many.
    ///
    /// # Errors
    /// [`CheckpointError::Missing`] if there is no such name.
    pub fn list(&self, name: &str) -> Result<Vec<f64>, CheckpointError> {
        Ok(self.words(name, 1)?.iter().map(|bits| f64::from_bits(*bits)).collect())
    }

    /// The `L` numbers of a name.
    ///
    /// # Errors
    /// [`CheckpointError::Missing`] if there is no such name, or another count of numbers.
    pub fn get<const L: usize>(&self, name: &str) -> Result<[f64; L], CheckpointError> {
        Ok(self.counts(name)?.map(f64::from_bits))
    }

    /// The `L` whole numbers of a name.
    ///
    /// # Errors
    /// [`CheckpointError::Missing`] if there is no such name, or another count of numbers.
    pub fn counts<const L: usize>(&self, name: &str) -> Result<[u64; L], CheckpointError> {
        let missing = |_| CheckpointError::Missing { name: name.to_owned(), count: L };
        <[u64; L]>::try_from(self.words(name, L)?).map_err(missing)
    }

    fn words(&self, name: &str, count: usize) -> Result<&[u64], CheckpointError> {
        let found = self.values.iter().find(|(other, _)| other == name);
        found.map(|(_, words)| &words[..]).ok_or_else(|| CheckpointError::Missing { name: name.to_owned(), count })
    }

    /// Checks that it belongs to the run of `expected`, which need not hold any numbers.
    ///
    /// # Errors
    /// [`CheckpointError::Other`] names the first thing that differs.
    pub fn belongs_to(&self, expected: &Self) -> Result<(), CheckpointError> {
        let none = "-".to_owned();
        let of = |pairs: &[(String, String)], name: &str| {
            pairs.iter().find(|(other, _)| other == name).map_or_else(|| none.clone(), |(_, value)| value.clone())
        };
        for (name, _) in expected.identity.iter().chain(&self.identity) {
            let (found, expected) = (of(&self.identity, name), of(&expected.identity, name));
            if found != expected {
                return Err(CheckpointError::Other { what: name.clone(), found, expected });
            }
        }
        Ok(())
    }

    /// A short value for a long description, to be part of an identity: its FNV-1a hash.
    #[must_use]
    pub fn fingerprint(description: &str) -> String {
        format!("{:016x}", hash(description))
    }

    /// The text of a file.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = format!("{HEADER} {VERSION}\n");
        // Writing to a string cannot fail.
        for (name, value) in &self.identity {
            let _ = writeln!(text, "{name} = {value}");
        }
        for (name, words) in &self.values {
            let _ = write!(text, "{name}:");
            for word in words {
                let _ = write!(text, " {word:016x}");
            }
            text.push('\n');
        }
        let hash = hash(&text);
        let _ = writeln!(text, "end {hash:016x}");
        text
    }

    /// Reads a text of [`to_text`](Self::to_text).
    ///
    /// # Errors
    /// [`CheckpointError`] if the text is no checkpoint, has another version, or is damaged.
    pub fn from_text(text: &str) -> Result<Self, CheckpointError> {
        use CheckpointError::{Damaged, NotOne, Version};
        let (first, _) = text.split_once('\n').ok_or(NotOne)?;
        let version = first.strip_prefix(HEADER).ok_or(NotOne)?.trim();
        if version != VERSION {
            return Err(Version { found: version.to_owned() });
        }
        let end = text.rfind("\nend ").ok_or(Damaged)? + 1;
        let (body, last) = text.split_at(end);
        if last != format!("end {:016x}\n", hash(body)) {
            return Err(Damaged);
        }
        let mut checkpoint = Self::default();
        for line in body.lines().skip(1) {
            if let Some((name, value)) = line.split_once(" = ") {
                checkpoint.identity.push((name.to_owned(), value.to_owned()));
            } else {
                let (name, words) = line.split_once(':').ok_or(Damaged)?;
                let words = words.split_whitespace().map(|word| u64::from_str_radix(word, 16));
                checkpoint.values.push((name.to_owned(), words.collect::<Result<_, _>>().map_err(|_| Damaged)?));
            }
        }
        Ok(checkpoint)
    }
}

/// FNV-1a of 64 bits: against accidents, not against malice.
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
