//! The scene argument of a command, and the options that override it.

use super::values::{number, scene_path};
use clap::Args;
use scene::{Overrides, Setting};

/// Settings that override values of the scene.
#[derive(Debug, Default, Args)]
pub(crate) struct Settings {
    /// Set a dotted key of the scene, for example sleigh.offset=0.3 or effects.0.stiffness=[1, 2]; can be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<Setting>,
}

#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// A scene file, the name of a bundled scene (see `noslip list scenes`), or - for the standard input
    #[arg(value_name = "SCENE", value_parser = scene_path())]
    pub(crate) scene: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Largest step [s], instead of the scene's
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = number)]
    pub(crate) step: Option<f64>,
    /// Duration [s], instead of the scene's; with a negative one `noslip run` goes backward in time
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    pub(crate) duration: Option<f64>,
    /// Weight of `dla-alpha`, from 0 to 1
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = number)]
    pub(crate) alpha: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Overwrite output files that exist already
    #[arg(long)]
    pub(crate) force: bool,
}

impl SceneArguments {
    /// The run settings of the flags, with a method and a duration (s).
    pub(crate) fn run<'a>(&self, method: Option<&'a str>, duration: Option<f64>) -> Overrides<'a> {
        Overrides { method, step: self.step, duration, alpha: self.alpha }
    }
}
