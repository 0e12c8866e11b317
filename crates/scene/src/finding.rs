use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::fmt;
use std::ops::Range;

/// What is wrong at one place of a scene, and what would be right.
///
/// Displayed, it is several lines of plain text without colours.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct SceneFinding {
    /// The file's name as it was given, the bundled scene's name, or `command line`.
    pub origin: String,
    /// Where in the text; `None` for what the command line gives.
    pub place: Option<Place>,
    /// The path of the key, like `sleigh.mass`, or the flag, like `--step`; `None` where the text has no keys to name.
    pub field: Option<String>,
    /// What is wrong with it, worded to follow the field.
    pub problem: String,
    /// What is there; `None` when it is missing.
    pub found: Option<String>,
    /// What may be there.
    pub accepted: String,
    /// What was probably meant.
    pub help: Option<String>,
    pub(crate) excerpt: Excerpt,
}

/// A place in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1, in characters.
    pub column: usize,
}

/// The line that an error shows, and the bytes of it that are marked.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Excerpt {
    pub(crate) line: String,
    pub(crate) span: Range<usize>,
}

impl SceneFinding {
    fn headline(&self) -> String {
        let mut headline = match &self.field {
            Some(field) => format!("`{field}` {}", self.problem),
            None => self.problem.clone(),
        };
        if self.place.is_none() {
            // Without a line to show, the headline says what a label under the line says otherwise.
            headline.insert_str(0, &format!("{}: ", self.origin));
            if let Some(found) = &self.found {
                headline.push_str(&format!(": found {found}"));
            }
        }
        headline
    }
}

impl fmt::Display for SceneFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.rendered(&Renderer::plain()))
    }
}

impl SceneFinding {
    /// What [`Display`](fmt::Display) shows, with the colours of a terminal.
    #[must_use]
    pub fn coloured(&self) -> String {
        self.rendered(&Renderer::styled())
    }

    fn rendered(&self, renderer: &Renderer) -> String {
        let Some(place) = self.place else {
            let help = self.help.as_ref().map_or_else(String::new, |help| format!("\n  = help: {help}"));
            return format!("{}\n  = accepted: {}{help}", self.headline(), self.accepted);
        };
        // The caller says that this is an error: a name of the level would say it twice.
        let mut group = annotate_snippets::Group::with_title(Level::ERROR.no_name().primary_title(self.headline()));
        let label = self.found.as_ref().map(|found| format!("found {found}"));
        group = group.element(
            Snippet::source(self.excerpt.line.as_str())
                .path(self.origin.as_str())
                .line_start(place.line)
                .annotation(AnnotationKind::Primary.span(self.excerpt.span.clone()).label(label)),
        );
        group = group.element(Level::NOTE.with_name("accepted").message(self.accepted.as_str()));
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        renderer.render(&[group])
    }
}
