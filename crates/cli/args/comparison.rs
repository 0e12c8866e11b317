//! Many methods: `noslip compare`, `precision` and `stability`.

use super::scene::{SceneArguments, Settings};
use super::values::{at_most_a_day, count, number, scene_path};
use clap::{ArgGroup, Args};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("saved").args(["checkpoint", "resume"]).multiple(true))]
pub(crate) struct CompareArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Methods, separated by commas [default: all]
    #[arg(long, value_name = "M,..", value_delimiter = ',')]
    pub(crate) methods: Option<Vec<String>>,
    /// Write a report with pictures into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Save the runs into this folder at intervals, and when a signal ends the command, so that --resume can
    /// continue the runs
    #[arg(long, value_name = "DIR")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Save each run every N steps
    #[arg(long, value_name = "N", default_value_t = 10_000_000, allow_hyphen_values = true, value_parser = count,
          requires = "saved")]
    pub(crate) checkpoint_every: u64,
    /// Continue the runs from the checkpoints in this folder, and save into the same folder unless --checkpoint
    /// names another; finished runs are not repeated
    #[arg(long, value_name = "DIR")]
    pub(crate) resume: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PrecisionArguments {
    /// A scene file, the name of a bundled scene (see `noslip list scenes`), or - for the standard input
    #[arg(value_name = "SCENE", value_parser = scene_path())]
    pub(crate) scene: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Methods, separated by commas [default: all]
    #[arg(long, value_name = "M,..", value_delimiter = ',')]
    pub(crate) methods: Option<Vec<String>>,
    /// Duration [s] [default: the scene's, at most 20 s, shortened until the reference is known to 1e-12]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    pub(crate) duration: Option<f64>,
    /// Weight of `dla-alpha`, from 0 to 1
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = number)]
    pub(crate) alpha: Option<f64>,
    /// Longest run of a method [s]; a method that has fewer than six points may take ten times as long
    #[arg(long, value_name = "S", default_value_t = 0.1, allow_hyphen_values = true, value_parser = at_most_a_day)]
    pub(crate) longest: f64,
    /// Points of another program to show too: a JSON file with the keys of --json; can be repeated
    #[arg(long, value_name = "FILE")]
    pub(crate) with: Vec<PathBuf>,
    /// Write a report with diagrams into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Write the points as comma-separated values
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Overwrite output files that exist already
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct StabilityArguments {
    /// One case (see `noslip list cases`) [default: all]
    #[arg(long, value_name = "NAME")]
    pub(crate) case: Option<String>,
    /// Methods, separated by commas [default: all]
    #[arg(long, value_name = "M,..", value_delimiter = ',')]
    pub(crate) methods: Option<Vec<String>>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}
