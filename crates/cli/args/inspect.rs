//! Arguments of commands that describe scenes and list names: `noslip check`, `equations`, `list` and `new`.

use super::scene::Settings;
use super::values::scene_path;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// Scene files, names of bundled scenes, or - for the standard input
    #[arg(value_name = "SCENE", value_parser = scene_path(), required = true)]
    pub(crate) scenes: Vec<String>,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Print one JSON array, an object for each scene
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct EquationsArguments {
    /// A scene file, the name of a bundled scene, or - for the standard input
    #[arg(value_name = "SCENE", value_parser = scene_path())]
    pub(crate) scene: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ListArguments {
    /// What to list
    pub(crate) what: Listed,
    /// Print one JSON array
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum Listed {
    /// The integrators
    Methods,
    /// The effects that can act on a body
    Effects,
    /// The bundled scenes
    Scenes,
    /// The hard cases of `noslip stability`
    Cases,
}

#[derive(Debug, Args)]
pub(crate) struct NewArguments {
    /// The file to write; - is standard output
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Overwrite a file that exists already
    #[arg(long)]
    pub(crate) force: bool,
}
