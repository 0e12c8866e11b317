//! Scenes of systems that are written as text.

mod faults;
mod start;
pub(crate) mod varied;
mod words;
mod written;

pub use self::start::Given;
use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::scene::{name_of, one_line};
use crate::table::TomlTable;
use crate::{BuiltScene, Overrides, RunSettings, Scene};
use ::sleigh::SleighError;
use ::text::{Family, TextMechanics, TextModel, TextStart, Words};
use assembly::AssemblyError;
use dla::{Schedule, fitted};
use std::fmt;
use std::sync::Arc;
use thiserror::Error;
use toml::de::DeTable;

/// A scene of a system of text: its texts, their meaning, its start and its run, all checked.
#[derive(Clone, PartialEq)]
pub struct TextScene {
    /// The bundled name, or the file's name without directory and ending.
    pub name: String,
    /// What the scene calls itself; the name when it does not.
    pub title: String,
    /// The texts of the system.
    pub words: Words,
    /// What they mean.
    pub model: Arc<TextModel>,
    /// What its start gives.
    pub given: Given,
    /// The start, which meets all constraints.
    pub start: TextStart,
    /// How to run it.
    pub run: RunSettings,
}

impl fmt::Debug for TextScene {
    /// Without the model, which follows from the words: its tables have another order in every process, and what tells a sweep from
    /// others is a hash of this text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, title, words, model: _, given, start, run } = self;
        let mut shown = f.debug_struct("TextScene");
        shown.field("name", name).field("title", title).field("words", words);
        shown.field("given", given).field("start", start).field("run", run).finish_non_exhaustive()
    }
}

/// A scene of either kind.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyScene {
    /// A sleigh, and what acts on it.
    Sleigh(Box<Scene>),
    /// A system of text.
    Text(Box<TextScene>),
}

/// Why a scene has no system.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BuildError {
    /// The error of a sleigh.
    #[error(transparent)]
    Sleigh(#[from] SleighError),
    /// Of a train.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A system of text has no start, or more constraints than coordinates.
    #[error("the system has a start with fewer coordinates, or more constraints than coordinates")]
    NoRoom,
}

impl AnyScene {
    /// The scene of the tables of its text.
    pub(crate) fn of(
        document: Document<'_>,
        entries: &DeTable<'_>,
        methods: &[&str],
        overrides: &Overrides<'_>,
    ) -> Result<Self, SceneError> {
        Ok(if entries.contains_key("system") {
            Self::Text(Box::new(TextScene::of(document, entries, methods, overrides)?))
        } else {
            Self::Sleigh(Box::new(Scene::of(document, entries, methods, overrides)?))
        })
    }

    /// The scene with the given settings of its run replaced.
    ///
    /// # Errors
    /// [`SceneError`] when the settings are not valid together, as for a file; its field is the flag `--method`,
    /// `--step`, `--duration` or `--alpha` of a setting given here, its origin `command line`.
    pub fn with_overrides(mut self, overrides: &Overrides<'_>, methods: &[&str]) -> Result<Self, SceneError> {
        let outcome = self.run_mut().replace(overrides, methods).and_then(|()| match &self {
            Self::Sleigh(scene) => scene.too_many_jumps(),
            Self::Text(scene) => scene.too_many_jumps(),
        });
        outcome.map_err(|fault| overrides.error(fault, self.name()))?;
        Ok(self)
    }

    /// The bundled name, or the file's name without directory and ending.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Sleigh(scene) => &scene.name,
            Self::Text(scene) => &scene.name,
        }
    }

    /// The system of the scene, with its start.
    ///
    /// # Errors
    /// [`BuildError`] where there is no such system.
    pub fn built(&self) -> Result<BuiltScene, BuildError> {
        match self {
            Self::Sleigh(scene) => scene.built(),
            Self::Text(scene) => scene.built(),
        }
    }

    /// As [`built`](Self::built), for an analysis, which has no trains.
    ///
    /// # Errors
    /// As [`built`](Self::built), and [`SleighError::Train`] of a train.
    pub fn built_for_analysis(&self) -> Result<BuiltScene, BuildError> {
        match self {
            Self::Sleigh(scene) if scene.has_trailers() => Err(SleighError::Train.into()),
            scene => scene.built(),
        }
    }

    /// Whether anything in the scene is a function of time.
    #[must_use]
    pub fn depends_on_time(&self) -> bool {
        match self {
            Self::Sleigh(scene) => scene.depends_on_time(),
            Self::Text(scene) => scene.model.depends_on_time(),
        }
    }

    /// The scene with steps across the corners in time of a system of text, as [`TextScene::uncut`]; jumps of a sleigh stay.
    #[must_use]
    pub fn uncut(self) -> Self {
        match self {
            Self::Text(scene) => Self::Text(Box::new(scene.uncut())),
            sleigh @ Self::Sleigh(_) => sleigh,
        }
    }

    /// The steps of the run, as [`Scene::schedule`].
    #[must_use]
    pub fn schedule(&self) -> Schedule {
        match self {
            Self::Sleigh(scene) => scene.schedule(),
            Self::Text(scene) => scene.schedule(),
        }
    }

    /// How to run it.
    #[must_use]
    pub fn run(&self) -> &RunSettings {
        match self {
            Self::Sleigh(scene) => &scene.run,
            Self::Text(scene) => &scene.run,
        }
    }

    /// The settings of the run, mutable.
    pub fn run_mut(&mut self) -> &mut RunSettings {
        match self {
            Self::Sleigh(scene) => &mut scene.run,
            Self::Text(scene) => &mut scene.run,
        }
    }

    /// What the scene calls itself.
    #[must_use]
    pub fn title(&self) -> &str {
        match self {
            Self::Sleigh(scene) => &scene.title,
            Self::Text(scene) => &scene.title,
        }
    }
}

impl TextScene {
    fn of(
        document: Document<'_>,
        entries: &DeTable<'_>,
        methods: &[&str],
        overrides: &Overrides<'_>,
    ) -> Result<Self, SceneError> {
        let root = TomlTable::of_system(document, entries)?;
        let name = name_of(document.origin);
        let title = one_line(root.text("title", "a string")?.unwrap_or(&name));
        let (words, places) = words::read(&root)?;
        let model = TextModel::new(&words).map_err(|error| places.fail(&document, &words, &error))?;
        let (start, given) = start::read(&root, &model)?;
        let table = root.table("run")?;
        let run = RunSettings::read(&table, overrides, &name, methods)?;
        let scene = Self { name, title, words, model: Arc::new(model), given, start, run };
        scene.too_many_jumps().map_err(|fault| overrides.error_in(&table, fault, &scene.name))?;
        Ok(scene)
    }

    /// A complete scene with comments, to start a new file from.
    #[must_use]
    pub fn template() -> &'static str {
        include_str!("../template_system.toml")
    }

    /// The steps of the run, as [`Scene::schedule`].
    #[must_use]
    pub fn schedule(&self) -> Schedule {
        let whole = Schedule { t0: 0.0, step: self.run.actual_step(), steps: self.run.steps() };
        fitted(&whole, self.run.step, self.jumps())
    }

    /// The scene with steps across corners in time, for derivatives of steps of one length.
    #[must_use]
    pub fn uncut(&self) -> Self {
        Self { model: Arc::new(self.model.uncut()), ..self.clone() }
    }

    /// The times in the run (s) at which a formula has a corner in time, or jumps.
    #[must_use]
    pub fn jumps(&self) -> Vec<f64> {
        self.model.jumps(0.0, self.run.duration).unwrap_or_default()
    }

    /// The fault of a run with more corners than can be told.
    fn too_many_jumps(&self) -> Result<(), Fault> {
        let jumps = self.model.jumps(0.0, self.run.duration);
        jumps.map(|_| ()).ok_or_else(|| Fault::too_many_corners(self.run.duration))
    }

    /// The system of the scene, with its start.
    ///
    /// # Errors
    /// [`BuildError::NoRoom`] of a scene that was not read from a text: sizes were checked there.
    pub fn built(&self) -> Result<BuiltScene, BuildError> {
        self.begun(TextMechanics::new(&self.model, &self.start))
    }

    /// The scene's system as the member of a [`Family`] in some of its parameters.
    ///
    /// # Errors
    /// As [`built`](Self::built).
    pub fn built_in(&self, family: &Family) -> Result<BuiltScene, BuildError> {
        self.begun(TextMechanics::of_family(family, &self.start))
    }

    fn begun(&self, system: Option<TextMechanics>) -> Result<BuiltScene, BuildError> {
        Ok(BuiltScene::of_text(system.ok_or(BuildError::NoRoom)?, &self.start))
    }
}
