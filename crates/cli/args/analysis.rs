//! Arguments of the analyses of motions: `noslip equilibria`, `phase`, `lyapunov` and `section`.

use super::scene::SceneArguments;
use super::values::{count, not_negative, number};
use crate::coordinate::Range;
use crate::plane::{Crossed, Plane};
use clap::Args;
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
