use crate::bundled::TEMPLATE;
use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::run::{Overrides, RunSettings};
use crate::table::TomlTable;
use crate::{SceneEffect, effects, sections};
use serde::Serialize;
use sleigh::{PathShape, Sleigh, SleighState, TimeFunction};
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
    /// The start: `x` and `y` in m and `heading` in rad, 0 when left out; `speed` in m/s, or `x_dot` and `y_dot`, and `turn_rate` in rad/s,
    /// required.
    pub start: SleighState,
    /// How to run it.
    pub run: RunSettings,
    /// What the entries `[[effects]]` name, in their order.
    pub effects: Vec<SceneEffect>,
}

impl Scene {
    /// The scene of the tables of its text.
    pub(crate) fn of(
        document: Document<'_>,
        entries: &DeTable<'_>,
        methods: &[&str],
        overrides: &Overrides<'_>,
    ) -> Result<Self, SceneError> {
        if let Some(system) = entries.get("system") {
            return Err(document.fail(&system.span(), Some("system".to_owned()), of_text()));
        }
        let root = TomlTable::root(document, entries)?;
        let name = name_of(document.origin);
        let title = one_line(root.text("title", "a string")?.unwrap_or(&name));
        let sleigh = sections::sleigh(&root.table("sleigh")?)?;
        let begin = root.table("start")?;
        let start = sections::start(&begin)?;
        let table = root.table("run")?;
        let run = RunSettings::read(&table, overrides, &name, methods)?;
        let effects = effects::read(&root, &sleigh)?;
        let scene = Self { name, title, sleigh, start, run, effects };
        scene.too_many_jumps().map_err(|fault| overrides.error_in(&table, fault, &scene.name))?;
        match scene.not_finite() {
            None => sections::check_slip(&begin, &start, scene.table_rate().unwrap_or(0.0)).map(|()| scene),
            Some(fault) => Err(begin.fail(fault)),
        }
    }

    /// The scene as a file that reads back as the same scene, number by number.
    ///
    /// # Errors
    /// [`toml::ser::Error`], which a scene of finite numbers does not give.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let Self { name: _, title, sleigh, start, run, effects } = self;
        toml::to_string(&WrittenFile { title, sleigh, start, run, effects })
    }

    /// A complete scene with comments, to start a new file from.
    #[must_use]
    pub fn template() -> &'static str {
        TEMPLATE
    }

    /// The fault of a run with more jumps than memory holds.
    pub(crate) fn too_many_jumps(&self) -> Result<(), Fault> {
        for effect in &self.effects {
            let unknown = |function: &TimeFunction| match function {
                TimeFunction::Formula(formula) => formula.corners(0.0, self.run.duration).is_none(),
                _ => false,
            };
            if effect.functions().into_iter().any(unknown) {
                return Err(Fault::too_many_corners(self.run.duration));
            }
            let SceneEffect::Tracer { path } = effect else { continue };
            let PathShape::Polygon(polygon) = path.shape() else { continue };
            let (corners, period) = (polygon.vertices().len(), path.period());
            let jumps = self.run.duration / period * corners as f64;
            if jumps > MOST_JUMPS || jumps.is_nan() {
                let most = MOST_JUMPS / corners as f64 * period;
                return Err(Fault::new(
                    SceneError::OutOfRange,
                    "duration",
                    "has more than 1e6 corners of the tracer's path",
                    format!("at most {most:e} s, for a path of {corners} corners and a period of {period:?} s"),
                )
                .found(format!("{:?}", self.run.duration)));
            }
        }
        Ok(())
    }

    /// The fault of a start whose energy is not a finite number, if there is one: of the speed or the turn rate where its kinetic
    /// energy overflows, else of the place.
    fn not_finite(&self) -> Option<Fault> {
        let (mass, inertia, offset) = (self.sleigh.mass(), self.sleigh.inertia(), self.sleigh.offset());
        let fast = |key: &'static str, value: f64, mass: f64, unit: &str| {
            (!(0.5 * mass * value * value).is_finite()).then(|| {
                Fault::new(
                    SceneError::OutOfRange,
                    key,
                    "makes the kinetic energy too large for a number",
                    format!("from -L to L with L = {:.3e}, in {unit}", (f64::MAX / mass.max(1.0)).sqrt()),
                )
                .found(format!("{value:?}"))
            })
        };
        fast("speed", self.start.speed, mass, "m/s")
            .or_else(|| fast("turn_rate", self.start.turn_rate, inertia + mass * offset * offset, "rad/s"))
            .or_else(|| {
                let energy = self.energy().ok().filter(|energy| !energy.is_finite())?;
                Some(Fault::new(
                    SceneError::OutOfRange,
                    "x",
                    format!("and the rest of the start have the energy {energy} J, which is not a finite number"),
                    "a start, and effects, with an energy that is a finite number, in J",
                ))
            })
    }
}

/// A scene as its file has it.
#[derive(Serialize)]
struct WrittenFile<'s> {
    title: &'s str,
    sleigh: &'s Sleigh,
    start: &'s SleighState,
    run: &'s RunSettings,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    effects: &'s [SceneEffect],
}

/// Maximum number of corners of a tracer's path in a run.
const MOST_JUMPS: f64 = 1e6;

fn of_text() -> Fault {
    let problem = "makes the scene a system of text, and this command needs a sleigh";
    Fault::new(SceneError::UnknownKey, "", problem, "the tables `[sleigh]`, `[start]` and `[run]`")
        .help("all commands except `phase` take systems of text".to_owned())
}

/// A title stands on one line.
pub(crate) fn one_line(title: &str) -> String {
    title.replace(|c: char| c.is_whitespace() && (c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')), " ")
}

pub(crate) fn name_of(origin: &str) -> String {
    Path::new(origin).file_stem().map_or_else(|| origin.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
