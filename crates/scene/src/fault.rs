use crate::error::SceneError;
use crate::finding::{Excerpt, Place, SceneFinding};

/// A fault that has no place yet: what the checks of values return, whether the values come from a file or from the
/// command line.
#[derive(Debug)]
pub(crate) struct Fault {
    /// The variant to become.
    pub(crate) variant: fn(Box<SceneFinding>) -> SceneError,
    /// The key at fault, without the path of its table.
    pub(crate) key: &'static str,
    pub(crate) problem: String,
    pub(crate) found: Option<String>,
    pub(crate) accepted: String,
    pub(crate) help: Option<String>,
}

impl Fault {
    /// A fault of the value of `key`, with the problem and the accepted values.
    pub(crate) fn new(
        variant: fn(Box<SceneFinding>) -> SceneError,
        key: &'static str,
        problem: impl Into<String>,
        accepted: impl Into<String>,
    ) -> Self {
        Self { variant, key, problem: problem.into(), found: None, accepted: accepted.into(), help: None }
    }

    /// With the value found.
    pub(crate) fn found(self, found: impl Into<Option<String>>) -> Self {
        Self { found: found.into(), ..self }
    }

    /// With what was probably meant.
    pub(crate) fn help(self, help: impl Into<Option<String>>) -> Self {
        Self { help: help.into(), ..self }
    }

    /// The fault of a run with more corners of formulas of time than can be found.
    pub(crate) fn too_many_corners(duration: f64) -> Self {
        let problem = "has more than 1e5 corners or jumps of `abs`, `sign`, `min` and `max` in the formulas of time";
        let accepted = "a run with fewer of them, each of which ends a step";
        Self::new(SceneError::OutOfRange, "duration", problem, accepted)
            .found(format!("{duration:?}"))
            .help("shorten the run, or use smooth functions, as `tanh(x/eps)` for `sign(x)`".to_owned())
    }

    /// The error at a place of a text; what the text says there is shown and need not be found again.
    pub(crate) fn at(self, origin: &str, place: Option<Place>, field: Option<String>, excerpt: Excerpt) -> SceneError {
        (self.variant)(Box::new(SceneFinding {
            origin: origin.to_owned(),
            place,
            field,
            problem: self.problem,
            found: self.found,
            accepted: self.accepted,
            help: self.help,
            excerpt,
        }))
    }
}
