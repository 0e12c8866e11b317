use crate::bundled::TEMPLATE;
use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::run::{RunSettings, flag_error};
use crate::table::Table;
use crate::{PathSpec, SceneEffect, Shape, effects, sections};
use lagrangian::whole_steps;
use sleigh::{Sleigh, SleighState};
use std::path::Path;
use toml::de::DeTable;

/// A scene: a sleigh, its start and its run, all checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The bundled name, or the file's name without directory and ending.
    pub name: String,
    /// What the scene calls itself; the name when it does not.
    pub title: String,
    /// The body: `mass` in kg, `inertia` in kg m^2 and `offset` in m, all required.
    pub sleigh: Sleigh,
    /// The start: `x` and `y` in m and `heading` in rad, 0 when left out; `speed` in m/s and `turn_rate` in rad/s,
    /// required.
    pub start: SleighState,
    /// How to run it.
    pub run: RunSettings,
    /// What the entries `[[effects]]` name, in their order.
    pub effects: Vec<SceneEffect>,
}

impl Scene {
    /// Reads a scene from text.
    ///
    /// `origin` is the file's name: messages show it, and the scene's name derives from it. `methods` are the names
    /// that `run.method` may have.
    ///
    /// # Errors
    /// [`SceneError`] with the first thing that is wrong with the text: its syntax, an unknown, missing or misplaced
    /// key, a value of the wrong type or out of its range.
    pub fn parse(text: &str, origin: &str, methods: &[&str]) -> Result<Self, SceneError> {
        // A byte-order mark is no part of the first line.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let document = Document { origin, text };
        let entries = DeTable::parse(text).map_err(|error| document.syntax(&error))?.into_inner();
        if entries.is_empty() {
            return Err(empty(&document));
        }
        if let Some(system) = entries.get("system") {
            return Err(document.fail(&system.span(), Some("system".to_owned()), of_text()));
        }
        let root = Table::root(document, &entries)?;
        let name = name_of(origin);
        let title = root.text("title", "a string")?.unwrap_or(&name).to_owned();
        let sleigh = sections::sleigh(&root.table("sleigh")?)?;
        let start = sections::start(&root.table("start")?)?;
        let run = RunSettings::read(&root.table("run")?, methods)?;
        let effects = effects::read(&root, sleigh.offset())?;
        let scene = Self { name, title, sleigh, start, run, effects };
        match scene.misaligned() {
            None => Ok(scene),
            Some(time) => Err(root.table("run")?.fail(unaligned(time))),
        }
    }

    /// The first time at which a table or a corner of a path jumps inside a step.
    fn misaligned(&self) -> Option<f64> {
        // A round within a step has a corner inside it, and a run may have more of them than memory holds.
        let hasty = self.effects.iter().find_map(|effect| match effect {
            SceneEffect::Tracer { path: PathSpec { shape: Shape::Polygon(_), period } } => Some(*period),
            _ => None,
        });
        if let Some(period) = hasty
            && period < self.run.actual_step()
        {
            return Some(period);
        }
        let step = self.run.actual_step();
        let inside = |t: &f64| whole_steps(t / step).is_none();
        self.jumps().ok()?.into_iter().filter(inside).min_by(f64::total_cmp)
    }

    /// Reads the bundled scene of that name, the standard input for `-`, or else the file at that path: `./turnaround` is always the
    /// file.
    ///
    /// # Errors
    /// [`SceneError`] when there is neither, when the file cannot be read, is not UTF-8 or is larger than 16 MiB, and
    /// as [`Scene::parse`] for its text.
    pub fn load(name_or_path: &str, methods: &[&str]) -> Result<Self, SceneError> {
        Self::load_with(name_or_path, &[], methods)
    }

    /// A complete scene with comments, to start a new file from.
    #[must_use]
    pub fn template() -> &'static str {
        TEMPLATE
    }

    /// The scene with other settings of its run, where they are given: method, step and duration in s, and alpha.
    ///
    /// # Errors
    /// [`SceneError`] when the settings are not valid together, as for a file; its field is the flag `--method`,
    /// `--step`, `--duration` or `--alpha` of a setting given here, its origin `command line`.
    pub fn with_overrides(
        mut self,
        method: Option<&str>,
        step: Option<f64>,
        duration: Option<f64>,
        alpha: Option<f64>,
        methods: &[&str],
    ) -> Result<Self, SceneError> {
        self.run.replace(&self.name, method, step, duration, alpha, methods)?;
        match self.misaligned() {
            None => Ok(self),
            Some(time) => Err(flag_error(unaligned(time), step.is_some(), &self.name)),
        }
    }
}

/// A jump that falls inside a step.
fn unaligned(time: f64) -> Fault {
    Fault {
        variant: SceneError::OutOfRange,
        key: "step",
        problem: format!("makes no node at t = {time:?} s, where an effect jumps"),
        found: None,
        accepted: format!("a step that divides {time:?} s, and every other time at which a table or a path jumps"),
        help: None,
    }
}

/// A system of text where a sleigh is needed.
fn of_text() -> Fault {
    Fault {
        variant: SceneError::UnknownKey,
        key: "",
        problem: "makes this a system of text, and a sleigh is needed here".to_owned(),
        found: None,
        accepted: "the tables `[sleigh]`, `[start]` and `[run]`".to_owned(),
        help: Some("`run`, `compare` and `check` take systems of text".to_owned()),
    }
}

pub(crate) fn empty(document: &Document<'_>) -> SceneError {
    let fault = Fault {
        variant: SceneError::Missing,
        key: "",
        problem: "the scene is empty".to_owned(),
        found: None,
        accepted: "the tables `[sleigh]` or `[system]`, `[start]` and `[run]`".to_owned(),
        help: Some("`noslip new FILE` writes a scene to start from".to_owned()),
    };
    document.fail(&(0..0), None, fault)
}

pub(crate) fn name_of(origin: &str) -> String {
    Path::new(origin).file_stem().map_or_else(|| origin.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
