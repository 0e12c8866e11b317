use crate::finding::SceneFinding;
use std::io;
use thiserror::Error;

/// Why there is no scene.
///
/// Displayed, an error of a file is a headline that names the field, the line at fault with the place marked, and a note on the
/// accepted values. It ends without a line break.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The text is not TOML.
    #[error("{0}")]
    Syntax(Box<SceneFinding>),
    /// The file's bytes are not UTF-8.
    #[error("{0}")]
    Encoding(Box<SceneFinding>),
    /// A table or a required key is not there.
    #[error("{0}")]
    Missing(Box<SceneFinding>),
    /// A key that no scene has.
    #[error("{0}")]
    UnknownKey(Box<SceneFinding>),
    /// A method or an effect that this version does not have.
    #[error("{0}")]
    UnknownName(Box<SceneFinding>),
    /// Not a number, not a string or not a table where one belongs.
    #[error("{0}")]
    WrongType(Box<SceneFinding>),
    /// A number that is not finite, that no body or run can have, or that does not go with another.
    #[error("{0}")]
    OutOfRange(Box<SceneFinding>),
    /// A text of a system that is no formula, or not one that may stand there; or a system that such texts do not determine.
    #[error("{0}")]
    Formula(Box<SceneFinding>),
    /// Neither a bundled scene nor a file.
    #[error(
        "no bundled scene and no file is named `{}`{}\n  = accepted: the path of a scene file, or one of {}",
        .origin.escape_debug(), did_you_mean(*.suggestion), .bundled.join(", ")
    )]
    NotFound {
        /// The name or path that was asked for.
        origin: String,
        /// The bundled scene of the nearest name, if one is near.
        suggestion: Option<&'static str>,
        /// The names of all bundled scenes.
        bundled: Vec<&'static str>,
    },
    /// The path is a directory.
    #[error("`{}` is a directory\n  = accepted: the path of a scene file, or the name of a bundled scene", .origin.escape_debug())]
    Directory {
        /// The path.
        origin: String,
    },
    /// The file is larger than any scene.
    #[error("`{}` is not a scene: it is larger than {limit} bytes", .origin.escape_debug())]
    TooLarge {
        /// The path.
        origin: String,
        /// The largest size that is read, in bytes.
        limit: u64,
    },
    /// The operating system does not let the file be read.
    #[error("`{}` cannot be read: {message}", .origin.escape_debug())]
    Unreadable {
        /// The path.
        origin: String,
        /// The kind of failure.
        kind: io::ErrorKind,
        /// The words of the operating system.
        message: String,
    },
}

impl SceneError {
    /// The place of the error in the text and the accepted values; `None` if there is no text.
    #[must_use]
    pub fn finding(&self) -> Option<&SceneFinding> {
        match self {
            Self::Syntax(finding)
            | Self::Encoding(finding)
            | Self::Missing(finding)
            | Self::UnknownKey(finding)
            | Self::UnknownName(finding)
            | Self::WrongType(finding)
            | Self::OutOfRange(finding)
            | Self::Formula(finding) => Some(finding),
            Self::NotFound { .. } | Self::Directory { .. } | Self::TooLarge { .. } | Self::Unreadable { .. } => None,
        }
    }

    /// As [`finding`](Self::finding), mutable.
    pub(crate) fn finding_mut(&mut self) -> Option<&mut SceneFinding> {
        match self {
            Self::Syntax(finding)
            | Self::Encoding(finding)
            | Self::Missing(finding)
            | Self::UnknownKey(finding)
            | Self::UnknownName(finding)
            | Self::WrongType(finding)
            | Self::OutOfRange(finding)
            | Self::Formula(finding) => Some(finding),
            Self::NotFound { .. } | Self::Directory { .. } | Self::TooLarge { .. } | Self::Unreadable { .. } => None,
        }
    }

    /// The file, bundled scene or `command line` that the error is about.
    #[must_use]
    pub fn origin(&self) -> &str {
        match self {
            Self::NotFound { origin, .. }
            | Self::Directory { origin }
            | Self::TooLarge { origin, .. }
            | Self::Unreadable { origin, .. } => origin,
            // The remaining variants all hold a finding.
            other => other.finding().map_or("", |finding| finding.origin.as_str()),
        }
    }
}

fn did_you_mean(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}
