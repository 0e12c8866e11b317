use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::suggest;
use ::text::{Entry, Problem, TextError, Words};
use std::ops::Range;

/// Where the texts of a system stand in a file.
#[derive(Debug, Default)]
pub(crate) struct TextPlaces {
    all: Vec<(Entry, String, Range<usize>)>,
}

impl TextPlaces {
    /// Notes the path and the place of an entry.
    pub(crate) fn add(&mut self, entry: Entry, field: String, span: Range<usize>) {
        self.all.push((entry, field, span));
    }

    /// What is wrong with a text, at its place.
    pub(crate) fn fail(&self, document: &Document<'_>, words: &Words, error: &TextError) -> SceneError {
        let place = self.all.iter().find(|(entry, ..)| *entry == error.entry).or_else(|| self.all.first());
        let Some((_, field, span)) = place else {
            return document.fail(&(0..0), None, fault(words, error));
        };
        let marked = match (error.column(), written(error.entry, words)) {
            (Some(column), Some(text)) => marked(document, span, text, column, length(&error.problem)),
            _ => span.clone(),
        };
        document.fail(&marked, Some(field.clone()), fault(words, error))
    }
}

fn fault(words: &Words, error: &TextError) -> Fault {
    let mut problem = error.problem.to_string();
    // The place is shown.
    if let Some(column) = error.column() {
        problem = problem.replace(&format!(" (column {column})"), "");
    }
    Fault {
        variant: SceneError::Formula,
        key: "",
        problem: format!("is wrong: {problem}"),
        found: None,
        accepted: accepted(error.entry, words),
        help: None,
    }
}

/// What may stand in an entry.
fn accepted(entry: Entry, words: &Words) -> String {
    let coordinates: Vec<&str> = words.coordinates.iter().map(|(name, _)| name.as_str()).collect();
    let rates: Vec<String> = coordinates.iter().map(|name| format!("{name}'")).collect();
    let rates: Vec<&str> = rates.iter().map(String::as_str).collect();
    let others = words.parameters.iter().map(|(name, _)| name.as_str());
    let others: Vec<&str> = others.chain(words.abbreviations.iter().map(|(name, _)| name.as_str())).collect();
    let of = |names: &[&[&str]]| {
        const SHOWN: usize = 40;
        let names = names.concat();
        let more = if names.len() > SHOWN { ", .." } else { "" };
        let shown = suggest::list(&names[..names.len().min(SHOWN)]);
        format!("a formula in {shown}{more}, with numbers, `pi`, + - * / ^ and functions such as `sin`")
    };
    let time: &[&str] = &["t"];
    match entry {
        Entry::System => "coordinates, a Lagrangian, and no more constraints than coordinates".to_owned(),
        Entry::Coordinate(_) => "a name of letters, digits and `_`, with its unit in quotes, or \"angle\"".to_owned(),
        Entry::Parameter(_) => "a name of letters, digits and `_`, with a finite number".to_owned(),
        Entry::Abbreviation(k) => {
            let before = words.parameters.len() + k;
            of(&[time, &coordinates, &rates, &others[..before.min(others.len())]])
        }
        Entry::Lagrangian | Entry::Constraint(_) | Entry::Force(_) | Entry::Output(_) => {
            of(&[time, &coordinates, &rates, &others])
        }
        Entry::Position(_) | Entry::Component(..) => of(&[time, &coordinates, &others]),
        Entry::Basis | Entry::Vector(_) => "a list of vectors, each with a formula for every coordinate".to_owned(),
    }
}

/// The text of an entry.
fn written(entry: Entry, words: &Words) -> Option<&str> {
    Some(match entry {
        Entry::Abbreviation(k) => &words.abbreviations.get(k)?.1,
        Entry::Lagrangian => &words.lagrangian,
        Entry::Constraint(k) => words.constraints.get(k)?,
        Entry::Position(k) => words.positions.get(k)?,
        Entry::Force(k) => &words.forces.get(k)?.1,
        Entry::Component(k, i) => words.basis.get(k)?.get(i)?,
        Entry::Output(k) => &words.outputs.get(k)?.1,
        Entry::System | Entry::Coordinate(_) | Entry::Parameter(_) | Entry::Basis | Entry::Vector(_) => return None,
    })
}

/// How many characters are at fault.
fn length(problem: &Problem) -> usize {
    match problem {
        Problem::Expression(
            expression::Error::UnknownName { name, .. } | expression::Error::NotAFunction { name, .. },
        ) => name.chars().count(),
        Problem::RateOf { name, .. } => name.chars().count() + 1,
        _ => 1,
    }
}

/// The bytes of some characters of a text from a column on; of a string with escapes, which stands otherwise in the file, all of it.
fn marked(document: &Document<'_>, span: &Range<usize>, text: &str, column: usize, length: usize) -> Range<usize> {
    let raw = document.text.get(span.clone()).unwrap_or("");
    let Some(begin) = raw.find(text).filter(|_| !text.is_empty()) else { return span.clone() };
    let byte = |character: usize| text.char_indices().nth(character).map_or(text.len(), |(byte, _)| byte);
    let offset = span.start + begin;
    offset + byte(column - 1)..offset + byte(column - 1 + length)
}
