//! Arguments of the analyses of motions and of methods: `noslip equilibria`, `phase`, `lyapunov`, `section`, `compare`, `precision` and
//! `stability`.

use super::scene::{SceneArguments, Settings};
use super::values::{at_most_a_day, count, not_negative, number, scene_path};
use crate::coordinate::Range;
use crate::plane::{Crossed, Plane};
use clap::{ArgGroup, Args};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct EquilibriaArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method whose steps are linearised: of the family dla or rk4, instead of the scene's
    #[arg(long, value_name = "M")]
    pub(crate) method: Option<String>,
    /// Write a phase portrait of speed and turn rate: .svg
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PhaseArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method (see `noslip list methods`), instead of the scene's
    #[arg(long, value_name = "M")]
    pub(crate) method: Option<String>,
    /// Number of loops [default: the whole loops within the scene's duration]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = count)]
    pub(crate) loops: Option<u64>,
    /// Draw the turn of each loop against the heading before the loop: .svg
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct LyapunovArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method that can be differentiated: of the families dla or gauss
    #[arg(long, value_name = "M", default_value = "gauss8")]
    pub(crate) method: String,
    /// Number of exponents, the largest first [default: all]
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = count, conflicts_with = "map")]
    pub(crate) exponents: Option<u64>,
    /// Time to integrate before the exponents are measured, so that the motion settles [s] [default: a tenth of the
    /// duration]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = not_negative)]
    pub(crate) settle: Option<f64>,
    /// Energy of the start [J]: the velocities of the start are scaled to have this energy
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = number)]
    pub(crate) energy: Option<f64>,
    /// Map the largest exponent over a grid of starts; give --map twice: the horizontal axis, then the vertical axis
    #[arg(long, value_name = "NAME=FROM:TO:CELLS", allow_hyphen_values = true)]
    pub(crate) map: Vec<Range>,
    /// Write the estimates along the run, or the map, as numbers (.csv) or a picture (.svg), by the ending of the name
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SectionArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method (see `noslip list methods`)
    #[arg(long, value_name = "M", default_value = "gauss8")]
    pub(crate) method: String,
    /// The plane: a quantity and its value (x, y, heading, speed, turn_rate, center_x, center_y; along, across: the
    /// centre of mass relative to the origin, in body axes), or t=PERIOD: every multiple of a period. A heading is
    /// crossed once in every turn
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub(crate) plane: Plane,
    /// Which crossings count
    #[arg(long, value_enum, default_value_t = Crossed::Rising)]
    pub(crate) direction: Crossed,
    /// The two quantities to show of each crossing: the horizontal axis, then the vertical axis
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub(crate) axes: Option<Vec<String>>,
    /// Number of starts: the scene's start, and others with the same position and energy
    #[arg(long, value_name = "N", default_value_t = 12, allow_hyphen_values = true, value_parser = count)]
    pub(crate) starts: u64,
    /// Energy of all starts [J], instead of the scene's
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = number)]
    pub(crate) energy: Option<f64>,
    /// Write the crossings as numbers (.csv) or a picture (.svg), by the ending of the name
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("saved").args(["checkpoint", "resume"]).multiple(true))]
pub(crate) struct CompareArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Methods, separated by commas [default: all]
    #[arg(long, value_name = "M,..", value_delimiter = ',')]
    pub(crate) methods: Option<Vec<String>>,
    /// Print all columns: steps, the discrete constraint, the drift of the energy, Newton's iterations, the cost
    #[arg(long)]
    pub(crate) wide: bool,
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
    /// Print every point, and all columns
    #[arg(long)]
    pub(crate) wide: bool,
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
    /// Print a row for every method on every case, with what was measured and why
    #[arg(long)]
    pub(crate) wide: bool,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}
