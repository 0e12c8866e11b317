//! The command line, as its help shows it.

mod analysis;
mod files;
mod run;
mod scene;
mod values;

pub(crate) use self::scene::{SceneArguments, Settings};
pub(crate) use analysis::{
    CompareArguments, EquilibriaArguments, LyapunovArguments, PhaseArguments, PrecisionArguments, SectionArguments,
    StabilityArguments,
};
pub(crate) use files::{
    CheckArguments, DiffArguments, EnsembleArguments, EquationsArguments, ListArguments, Listed, MergeArguments,
    NewArguments, PlotArguments,
};
pub(crate) use run::RunArguments;
pub(crate) use values::Size;

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// The meaning of the exit codes, at the end of the help.
const EXIT_CODES: &str = "Exit codes:
  0    done
  1    the computation failed, or its result could not be written; the part that was computed is shown
  2    the request was wrong: nothing was computed
  130  ended by Ctrl-C, SIGTERM or SIGHUP; the part that was computed is shown";

/// Simulates systems with velocity constraints (blades, wheels, rolling bodies) and shows what accuracy costs.
///
/// Without a command, noslip compares five methods on one scene, in seconds: constraint, energy, error and time.
/// noslip also writes a page with pictures.
#[derive(Debug, Parser)]
#[command(name = "noslip", version, args_conflicts_with_subcommands = true, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) job: JobArguments,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Integrates a scene: one trajectory
    Run(RunArguments),
    /// Compares methods on a scene: constraint, energy and drift, error and time, method by method
    Compare(CompareArguments),
    /// Measures what accuracy costs in time: the error at the end against the time of a run, over a range of steps
    Precision(PrecisionArguments),
    /// Runs the methods on the hard cases: each method passes, refuses or fails
    Stability(StabilityArguments),
    /// Measures how much time each effect of a scene adds to a step of dla
    Cost(SceneArguments),
    /// Finds the steady motions of a scene, and the eigenvalues of the flow and of a method's steps about each motion
    Equilibria(EquilibriaArguments),
    /// Measures the angle by which each loop of a tracer turns the blade, beside the angle of the exact map
    Phase(PhaseArguments),
    /// Measures whether a motion is chaotic: its Lyapunov exponents, or a map of the largest over many starts
    ///
    /// Without --duration, one motion is measured over 10000 s, and each motion of a map over 500 s. Starts are
    /// computed on all threads; the number of threads (RAYON_NUM_THREADS) changes no result.
    Lyapunov(LyapunovArguments),
    /// Draws a Poincare section: where motions cross a plane
    ///
    /// Without --duration each motion is followed for 2000 s. In a scene that depends on time, only --plane
    /// t=PERIOD, with the period of the scene, shows the iterates of one map.
    Section(SectionArguments),
    /// Computes many variants of a scene: a grid of starts and parameters, or random samples, with a row for each
    /// variant
    ///
    /// Members are computed on all threads; the number of threads (RAYON_NUM_THREADS) changes no result.
    Ensemble(EnsembleArguments),
    /// Makes the result of a sweep from the parts that `ensemble --part` wrote, once all parts are there
    ///
    /// The result has the bytes that one process would have written.
    Merge(MergeArguments),
    /// Reads scenes, and describes each scene or says which key is wrong
    Check(CheckArguments),
    /// Prints the equations of motion of a system of text, reduced to a basis of its admissible velocities, for other programs
    Equations(EquationsArguments),
    /// Lists the methods, effects, bundled scenes or hard cases
    List(ListArguments),
    /// Writes a commented scene to start from
    New(NewArguments),
    /// Draws a run against time, and the path of the run: .svg, .png or .pdf, with a choice of size and resolution
    ///
    /// The run is read from a file that `run --out` wrote, or computed from a scene.
    Plot(PlotArguments),
    /// Compares two files of numbers, .csv or .npz: the largest difference in each column
    Diff(DiffArguments),
    /// Prints the completion script of a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Prints the manual page of the program, or of one command
    #[command(hide = true)]
    Man {
        /// The command
        command: Option<String>,
    },
}

#[derive(Debug, Args)]
pub(crate) struct JobArguments {
    /// Compare every method on every bundled scene, in a minute: a table for each scene, a table of all scenes, and
    /// one page
    #[arg(long)]
    pub(crate) all: bool,
    /// Print what the columns mean, without computing
    #[arg(long)]
    pub(crate) explain: bool,
    /// Folder for the report [default: noslip-report, or the next free noslip-report-N]
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Write into a report folder that exists already
    #[arg(long)]
    pub(crate) force: bool,
}
