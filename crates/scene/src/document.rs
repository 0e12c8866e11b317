use crate::error::SceneError;
use crate::fault::Fault;
use crate::finding::{Excerpt, Place};
use crate::keys;
use std::ops::Range;

/// The text of a scene and its origin. Turns byte ranges into line and column.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Document<'s> {
    pub(crate) origin: &'s str,
    pub(crate) text: &'s str,
}

impl Document<'_> {
    /// The fault as an error that marks `span`.
    pub(crate) fn fail(&self, span: &Range<usize>, field: Option<String>, fault: Fault) -> SceneError {
        let (place, excerpt) = self.locate(span);
        fault.at(self.origin, Some(place), field, excerpt)
    }

    /// An error of the TOML parser.
    pub(crate) fn syntax(&self, error: &toml::de::Error) -> SceneError {
        if error.message().contains("recurs") {
            return self.too_deep(error);
        }
        let span = error.span().unwrap_or(0..0);
        // The parser says "problem, expected this, that".
        let (problem, expected) = match error.message().split_once(", expected ") {
            None if error.message() == "duplicate key" => ("duplicate key", "every key and table once"),
            None => (error.message(), "TOML, as https://toml.io defines it"),
            Some(parts) => parts,
        };
        // Within the value of a known key, what that key accepts says more than what the parser would go on with.
        let value = self.key_before(span.start).and_then(|field| Some((keys::accepted(&field)?, field)));
        let (field, problem, accepted) = match value {
            Some((accepted, field)) => (Some(field), format!("is not TOML: {problem}"), accepted),
            None => (None, format!("not TOML: {problem}"), expected.to_owned()),
        };
        let fault = Fault::new(SceneError::Syntax, "", problem, accepted);
        self.fail(&span, field, fault)
    }

    /// The parser gives no place for what nests deeper than it reads: a key with that many dots, or that many brackets.
    fn too_deep(&self, error: &toml::de::Error) -> SceneError {
        let depth = |line: &str| line.chars().filter(|c| ".[{".contains(*c)).count();
        let lines = self.text.split_inclusive('\n').scan(0, |start, line| {
            let span = *start..*start + line.trim_end().len();
            *start += line.len();
            Some((span, depth(line)))
        });
        // Of lines that nest as deep, the first.
        let (span, _) = lines.reduce(|most, line| if line.1 > most.1 { line } else { most }).unwrap_or((0..0, 0));
        let fault = Fault::new(
            SceneError::Syntax,
            "",
            format!("TOML that this program does not read: {}", error.message()),
            "keys of fewer than 80 parts, and lists and tables within one another fewer than 80 deep",
        );
        self.fail(&span, None, fault)
    }

    /// The path of the key whose value `index` is in, as far as its line and the last header before it tell.
    fn key_before(&self, index: usize) -> Option<String> {
        let before = &self.text[..self.text.floor_char_boundary(index)];
        let (headers, line) = before.rsplit_once('\n').unwrap_or(("", before));
        let (key, _) = line.split_once('=')?;
        let header = headers.lines().rev().find_map(|line| line.trim_start().strip_prefix('['));
        let table = header.and_then(|header| header.split(']').next()).unwrap_or("").trim();
        Some(if table.is_empty() { key.trim().to_owned() } else { format!("{table}.{}", key.trim()) })
    }

    /// The number of the line of a place, from 1.
    pub(crate) fn line(&self, index: usize) -> usize {
        1 + self.text[..self.text.floor_char_boundary(index)].matches('\n').count()
    }

    /// The line and column where `span` begins, and the part of it on that line.
    fn locate(&self, span: &Range<usize>) -> (Place, Excerpt) {
        let text = self.text;
        let start = text.floor_char_boundary(span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let rest = &text[line_start..];
        let line = rest.split('\n').next().unwrap_or(rest);
        let line = line.strip_suffix('\r').unwrap_or(line);
        let in_line = |index: usize| line.floor_char_boundary(index.saturating_sub(line_start));
        let marked = in_line(start)..in_line(span.end.max(start));
        let place = Place { line: self.line(line_start), column: 1 + line[..marked.start].chars().count() };
        (place, Excerpt { line: line.to_owned(), span: marked })
    }
}
