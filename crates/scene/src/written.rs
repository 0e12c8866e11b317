use crate::{RunSettings, Scene, SceneEffect};
use serde::Serialize;

/// A scene as its file has it.
#[derive(Serialize)]
struct WrittenFile<'s> {
    title: &'s str,
    sleigh: SleighTable,
    start: StartTable,
    run: RunTable<'s>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    effects: &'s [SceneEffect],
}

#[derive(Serialize)]
struct SleighTable {
    mass: f64,
    inertia: f64,
    offset: f64,
}

#[derive(Serialize)]
struct StartTable {
    x: f64,
    y: f64,
    heading: f64,
    speed: f64,
    turn_rate: f64,
}

#[derive(Serialize)]
pub(crate) struct RunTable<'s> {
    method: &'s str,
    #[serde(skip_serializing_if = "Option::is_none")]
    alpha: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    step: f64,
    duration: f64,
}

impl<'s> RunTable<'s> {
    pub(crate) fn of(run: &'s RunSettings) -> Self {
        Self { method: &run.method, alpha: run.alpha, tolerance: run.tolerance, step: run.step, duration: run.duration }
    }
}

impl Scene {
    /// The scene as a file that reads back as the same scene, number by number.
    ///
    /// # Errors
    /// [`toml::ser::Error`], which a scene of finite numbers does not give.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let Self { title, sleigh, start, run, effects, .. } = self;
        toml::to_string(&WrittenFile {
            title,
            sleigh: SleighTable { mass: sleigh.mass(), inertia: sleigh.inertia(), offset: sleigh.offset() },
            start: StartTable {
                x: start.x,
                y: start.y,
                heading: start.heading,
                speed: start.speed,
                turn_rate: start.turn_rate,
            },
            run: RunTable::of(run),
            effects,
        })
    }
}
