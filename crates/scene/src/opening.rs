//! How scenes are opened: from a text or by name, with values in place of some of the text.

use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::settings::{Setting, parse_with};
use crate::{AnyScene, Overrides, Scene, bundled, file};
use std::borrow::Cow;
use toml::de::DeTable;

/// Opens scenes of either kind, or of sleighs alone.
macro_rules! openings {
    ($($scene:ident),+) => {
        $(impl $scene {
            /// Reads a scene from text.
            ///
            /// `origin` is the file's name: messages show it, and the scene's name derives from it. `methods` are the names
            /// that `run.method` may have.
            ///
            /// # Errors
            /// [`SceneError`] with the first thing that is wrong with the text: its syntax, an unknown, missing or misplaced
            /// key, a value of the wrong type or out of its range.
            pub fn parse(text: &str, origin: &str, methods: &[&str]) -> Result<Self, SceneError> {
                opened(text, origin, |document, entries| Self::of(document, entries, methods, &Overrides::default()))
            }

            /// Reads the bundled scene of that name, the standard input for `-`, or else the file at that path: `./turnaround` is
            /// always the file.
            ///
            /// # Errors
            /// [`SceneError`] when there is neither, when the file cannot be read, is not UTF-8 or is larger than 16 MiB, and
            /// as [`parse`](Self::parse) for its text.
            pub fn load(name_or_path: &str, methods: &[&str]) -> Result<Self, SceneError> {
                Self::load_with(name_or_path, &[], &Overrides::default(), methods)
            }

            /// As [`load`](Self::load), with other values in the text, and then with other settings of the run.
            ///
            /// # Errors
            /// As [`load`](Self::load), and [`SceneError`] if a setting has no place in the scene or makes it invalid. The field of an
            /// error of the overrides is the flag, as `--step`, and its origin `command line`.
            pub fn load_with(
                name_or_path: &str,
                settings: &[Setting],
                overrides: &Overrides<'_>,
                methods: &[&str],
            ) -> Result<Self, SceneError> {
                let (text, origin) = source(name_or_path)?;
                // A byte-order mark is no part of the first line.
                parse_with(text.strip_prefix('\u{feff}').unwrap_or(&text), &origin, settings, |text, origin| {
                    opened(text, origin, |document, entries| Self::of(document, entries, methods, overrides))
                })
            }
        })+
    };
}
openings!(Scene, AnyScene);

/// A text of a scene, and what messages call it: the bundled scene of that name, the standard input for `-`, or else a file.
pub(crate) fn source(name_or_path: &str) -> Result<(Cow<'static, str>, Cow<'_, str>), SceneError> {
    if let Some(scene) = bundled::named(name_or_path) {
        return Ok((Cow::Borrowed(scene.text), Cow::Borrowed(scene.name)));
    }
    let origin = if name_or_path == "-" { "stdin" } else { name_or_path };
    Ok((Cow::Owned(file::read(name_or_path)?), Cow::Borrowed(origin)))
}

/// Reads the tables of a scene's text, whichever kind the scene is.
fn opened<T>(
    text: &str,
    origin: &str,
    read: impl FnOnce(Document<'_>, &DeTable<'_>) -> Result<T, SceneError>,
) -> Result<T, SceneError> {
    // A byte-order mark is no part of the first line.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let document = Document { origin, text };
    let entries = DeTable::parse(text).map_err(|error| document.syntax(&error))?.into_inner();
    if entries.is_empty() {
        return Err(empty(&document));
    }
    read(document, &entries)
}

fn empty(document: &Document<'_>) -> SceneError {
    let fault = Fault::new(
        SceneError::Missing,
        "",
        "the scene is empty",
        "the tables `[sleigh]` or `[system]`, `[start]` and `[run]`",
    )
    .help("`noslip new FILE` writes a scene to start from".to_owned());
    document.fail(&(0..0), None, fault)
}
