//! Arguments of commands on files: `noslip plot`, `diff`, `ensemble`, `merge`, `check`, `equations`, `list` and `new`.

use super::scene::Settings;
use super::values::{Size, dpi, not_negative, number, scene_path};
use crate::ensemble::Share;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct PlotArguments {
    /// A file of a run, .csv or .npz; a scene file, the name of a bundled scene, or - for a scene on the standard input
    #[arg(value_name = "FILE_OR_SCENE", value_parser = scene_path())]
    pub(crate) input: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Methods of the runs of a scene, separated by commas [default: the scene's]
    #[arg(long, value_name = "M,..", value_delimiter = ',')]
    pub(crate) methods: Option<Vec<String>>,
    /// Largest step [s], instead of the scene's
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = number)]
    pub(crate) step: Option<f64>,
    /// Duration [s], instead of the scene's
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    pub(crate) duration: Option<f64>,
    /// Weight of `dla-alpha`, from 0 to 1
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = number)]
    pub(crate) alpha: Option<f64>,
    /// Columns to draw, separated by commas; `path` is the path [default: the path, velocities, heading, energy,
    /// constraint and reaction]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    pub(crate) columns: Option<Vec<String>>,
    /// Width and height, in cm, mm or in
    #[arg(long, value_name = "WxH", default_value = "17x20cm")]
    pub(crate) size: Size,
    /// Resolution of a .png, in pixels per inch
    #[arg(long, value_name = "N", default_value_t = 300, allow_hyphen_values = true, value_parser = dpi)]
    pub(crate) dpi: u32,
    /// The picture: .svg, .png or .pdf, by the ending [default: the name of the scene or file, .svg]
    #[arg(long, value_name = "PICTURE", visible_alias = "picture")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite a picture that exists already
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DiffArguments {
    /// A file of numbers: .csv or .npz, by the ending
    #[arg(value_name = "A")]
    pub(crate) first: PathBuf,
    /// The file to compare A with
    #[arg(value_name = "B")]
    pub(crate) second: PathBuf,
    /// Exit with code 1 if a difference is larger than SIZE
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, value_parser = not_negative)]
    pub(crate) within: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct EnsembleArguments {
    /// A sweep file, which names a scene and the keys that vary
    #[arg(value_name = "SWEEP", value_parser = scene_path())]
    pub(crate) sweep: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Write a row for each member to a file .csv, .jsonl, .npz or .parquet (a cargo feature), by the ending of the
    /// name; with --part, FILE is the folder of the parts
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Continue an interrupted run of the same sweep
    #[arg(long, requires = "out")]
    pub(crate) resume: bool,
    /// Compute part I of N equal parts (I from 1 to N) into the folder --out; `noslip merge` joins the parts. A part
    /// that exists is kept, and an interrupted part is continued
    #[arg(long, value_name = "I/N", requires = "out")]
    pub(crate) part: Option<Share>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Overwrite output files that exist already
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArguments {
    /// The folder of the parts
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// The file to write: .csv, .jsonl, .npz or .parquet (a cargo feature), by the ending of the name [default:
    /// DIR.csv]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite output files that exist already
    #[arg(long)]
    pub(crate) force: bool,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

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
    /// A system of text, of any Lagrangian, in place of a sleigh
    #[arg(long)]
    pub(crate) system: bool,
    /// Overwrite a file that exists already
    #[arg(long)]
    pub(crate) force: bool,
}
