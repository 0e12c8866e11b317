use crate::{Error, Function};
use std::collections::HashMap;

/// The constant that every text knows.
pub(crate) const PI: &str = "pi";

/// The names that a text may use, in an order of their own: what they mean is the business of who asks.
///
/// `x'` and `x_dot` are one name in two spellings.
///
/// ```
/// let names = expression::Names::of(["x", "x'"])?;
/// assert_eq!((names.position("x'"), names.position("x_dot"), names.position("y")), (Some(1), Some(1), None));
/// # Ok::<(), expression::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Names {
    all: Vec<String>,
    positions: HashMap<String, usize>,
}

impl Names {
    /// A table without names.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A table of these names.
    ///
    /// # Errors
    /// As [`add`](Self::add).
    pub fn of<N: AsRef<str>>(names: impl IntoIterator<Item = N>) -> Result<Self, Error> {
        let mut table = Self::new();
        for name in names {
            table.add(name.as_ref())?;
        }
        Ok(table)
    }

    /// Adds a name and says its position.
    ///
    /// # Errors
    /// [`Error::InvalidName`], [`Error::ReservedName`] and [`Error::DuplicateName`].
    pub fn add(&mut self, name: &str) -> Result<usize, Error> {
        let stem = name.trim_end_matches('\'');
        let mut letters = stem.chars();
        if !letters.next().is_some_and(starts_name) || !letters.all(in_name) {
            return Err(Error::InvalidName { name: name.to_owned() });
        }
        if reserved(name) {
            return Err(Error::ReservedName { name: name.to_owned() });
        }
        let position = self.all.len();
        if self.positions.insert(one_spelling(name), position).is_some() {
            return Err(Error::DuplicateName { name: name.to_owned() });
        }
        self.all.push(name.to_owned());
        Ok(position)
    }

    /// Where a name stands in the table, in either spelling.
    #[must_use]
    pub fn position(&self, name: &str) -> Option<usize> {
        self.positions.get(&one_spelling(name)).copied()
    }

    /// The names in their order.
    #[must_use]
    pub fn all(&self) -> &[String] {
        &self.all
    }

    /// The error for a name that is not in the table.
    pub(crate) fn unknown(&self, name: &str, column: usize) -> Error {
        let nearest = nearest(name, self.all.iter().map(String::as_str).chain([PI])).map(str::to_owned);
        Error::UnknownName { column, name: shortened(name), nearest, known: self.all.clone() }
    }
}

/// Whether a name may begin so.
pub(crate) fn starts_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

/// Whether a name may go on so.
pub(crate) fn in_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn reserved(name: &str) -> bool {
    // A name that became a function later may be that of a system, which does not call it.
    name == PI || name == "ln" || Function::named(name).is_some_and(|function| function != Function::Floor)
}

/// `x_dot` as `x'`.
fn one_spelling(name: &str) -> String {
    match name.strip_suffix("_dot") {
        Some(stem) if !stem.is_empty() => format!("{stem}'"),
        _ => name.to_owned(),
    }
}

/// The name whose rate a name is, in either spelling.
pub(crate) fn of_rate(name: &str) -> Option<&str> {
    name.strip_suffix('\'').or_else(|| name.strip_suffix("_dot"))
}

/// A name of a hostile text is not repeated whole.
pub(crate) fn shortened(name: &str) -> String {
    const SHOWN: usize = 40;
    if name.chars().count() <= SHOWN { name.to_owned() } else { name.chars().take(SHOWN).chain("..".chars()).collect() }
}

/// The candidate that `word` is a likely misspelling of, if there is one: the nearest by insertions, deletions, replacements and swaps
/// of neighbours, one for every three letters, case aside.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let length = word.chars().count();
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let letters = candidate.chars().count();
            let limit = letters.div_ceil(3);
            // The length bounds the distance from below, and keeps a word of a million letters from costing its square.
            if length.abs_diff(letters) > limit {
                return None;
            }
            let distance = strsim::osa_distance(&word, &candidate.to_lowercase());
            // A word of one letter has nothing in common with another.
            (distance <= limit && distance < letters).then_some((distance, candidate))
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}
