//! `noslip ensemble` and `merge`.

use super::values::scene_path;
use crate::ensemble::Share;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct EnsembleArguments {
    /// A sweep file, which names a scene and the keys that vary
    #[arg(value_name = "SWEEP", value_parser = scene_path())]
    pub(crate) sweep: String,
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
