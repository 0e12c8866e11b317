//! `noslip run`.

use super::scene::SceneArguments;
use super::values::{count, event_samples, number};
use crate::format::Format;
use crate::trigger::Trigger;
use clap::{ArgGroup, Args};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("watched").args(["event", "until"]).multiple(true))]
#[command(group = ArgGroup::new("saved").args(["checkpoint", "resume"]).multiple(true))]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method (see `noslip list methods`), instead of the scene's
    #[arg(long, value_name = "M")]
    pub(crate) method: Option<String>,
    /// Keep every N-th node in the output file
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = count)]
    pub(crate) every: u64,
    /// Write the trajectory to a file .csv, .jsonl, .npz or .parquet (a cargo feature), by the ending of the name; -
    /// is standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Write a page with pictures into this folder: the motion, the path, and the columns against time
    #[arg(long, value_name = "DIR", conflicts_with_all = ["checkpoint", "resume", "until", "tolerance", "substep"])]
    pub(crate) report: Option<PathBuf>,
    /// Format of the output file, whatever the ending of the name: csv, jsonl, npz, parquet [default for standard
    /// output: csv]
    #[arg(long, value_name = "FORMAT", requires = "out")]
    pub(crate) format: Option<Format>,
    /// Choose the longest step whose error, in metres or radians, stays below TOL, by trial runs; for a method with
    /// steps of its own, TOL is the error of each of these steps
    #[arg(long, value_name = "TOL", allow_hyphen_values = true, value_parser = number)]
    pub(crate) tolerance: Option<f64>,
    /// Divide a step that fails, or that does not resolve the motion, into parts; every step then takes the time of three steps
    #[arg(long)]
    pub(crate) substep: bool,
    /// Save the run to this file at intervals, so that --resume can continue the run
    #[arg(long, value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Save the run every N steps; with --resume and without --checkpoint, to the file of --resume [default: 1000000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = count, requires = "saved")]
    pub(crate) checkpoint_every: Option<u64>,
    /// Continue the run from this checkpoint, to the same last bit, also with a longer --duration; the file of --out
    /// is continued too
    #[arg(long, value_name = "FILE")]
    pub(crate) resume: Option<PathBuf>,
    /// Find the times at which a quantity crosses a value, for example speed=0, or speed=0:rising for one direction;
    /// can be repeated. A sleigh has x, y, heading (in every turn), unwrapped_heading (turns counted), speed, turn_rate,
    /// center_x, constraint_force, energy and others; a system of text has its coordinates, rates (x') and outputs
    #[arg(long, value_name = "NAME=VALUE[:DIRECTION]")]
    pub(crate) event: Vec<Trigger>,
    /// Find an event as --event does, and end the run at the event
    #[arg(long, value_name = "NAME=VALUE[:DIRECTION]")]
    pub(crate) until: Vec<Trigger>,
    /// Look for events in N parts of each step, and in N parts of each inner step of dop853
    #[arg(long, value_name = "N", default_value_t = harness::EVENT_SAMPLES, allow_hyphen_values = true,
          value_parser = event_samples, requires = "watched")]
    pub(crate) event_samples: u32,
}

impl RunArguments {
    /// The file of checkpoints, and the number of steps between two of them. A resumed run saves to the file of `--resume` if
    /// `--checkpoint-every` is given without `--checkpoint`.
    pub(crate) fn saves(&self) -> Option<(&Path, u64)> {
        let Self { checkpoint, checkpoint_every, resume, .. } = self;
        let to = checkpoint.as_ref().or(resume.as_ref().filter(|_| checkpoint_every.is_some()));
        to.map(|to| (to.as_path(), checkpoint_every.unwrap_or(1_000_000)))
    }
}
