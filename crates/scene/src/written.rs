use crate::{RunSettings, Scene, SceneEffect};
use serde::Serialize;
use sleigh::{Sleigh, SleighState};

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

impl Scene {
    /// The scene as a file that reads back as the same scene, number by number.
    ///
    /// # Errors
    /// [`toml::ser::Error`], which a scene of finite numbers does not give.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let Self { name: _, title, sleigh, start, run, effects } = self;
        toml::to_string(&WrittenFile { title, sleigh, start, run, effects })
    }
}
