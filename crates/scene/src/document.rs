use crate::error::SceneError;
use crate::fault::Fault;
use crate::finding::{Excerpt, Place};
use std::ops::Range;

/// The text of a scene and where it comes from: turns byte ranges into places.
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

    /// An error of the TOML parser, or of a deserialiser that was given a part of this text.
    pub(crate) fn toml_error(&self, error: &toml::de::Error) -> SceneError {
        // The parser says "problem, expected this, that".
        let (problem, accepted) = match error.message().split_once(", expected ") {
            Some((problem, expected)) => (problem.to_owned(), expected.to_owned()),
            None => (error.message().to_owned(), "TOML, as https://toml.io defines it".to_owned()),
        };
        let fault = Fault { variant: SceneError::Syntax, key: "", problem, found: None, accepted, help: None };
        self.fail(&error.span().unwrap_or(0..0), None, fault)
    }

    /// The line and column where `span` begins, and the part of it on that line.
    fn locate(&self, span: &Range<usize>) -> (Place, Excerpt) {
        let text = self.text;
        let start = floor_char_boundary(text, span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let rest = &text[line_start..];
        let line = rest.split('\n').next().unwrap_or(rest);
        let line = line.strip_suffix('\r').unwrap_or(line);
        let in_line = |index: usize| floor_char_boundary(line, index.saturating_sub(line_start));
        let marked = in_line(start)..in_line(span.end.max(start));
        let place = Place {
            line: 1 + text[..line_start].matches('\n').count(),
            column: 1 + line[..marked.start].chars().count(),
        };
        (place, Excerpt { line: line.to_owned(), span: marked })
    }
}

/// The last boundary between characters of `text` that is not after `index`.
fn floor_char_boundary(text: &str, index: usize) -> usize {
    (0..=index.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}
