use crate::coordinate::Range;
use crate::ensemble::share::Share;
use crate::format::Format;
use crate::plane::{Crossed, Plane};
use crate::trigger::Trigger;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use scene::Setting;
use std::path::PathBuf;
use std::str::FromStr;

/// What the exit codes say, at the end of the help.
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

/// Values in place of those of the scene.
#[derive(Debug, Default, Args)]
pub(crate) struct Settings {
    /// Set a dotted key of the scene, for example sleigh.offset=0.3 or effects.0.stiffness=[1, 2]; can be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<Setting>,
}

#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// A scene file, the name of a bundled scene (see `noslip list scenes`), or - for the standard input
    #[arg(value_name = "SCENE")]
    pub(crate) scene: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Largest step [s], instead of the scene's
    #[arg(long, value_name = "H", allow_negative_numbers = true, value_parser = number)]
    pub(crate) step: Option<f64>,
    /// Duration [s], instead of the scene's; with a negative one `noslip run` goes backward in time
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    pub(crate) duration: Option<f64>,
    /// Weight of `dla-alpha`, from 0 to 1
    #[arg(long, value_name = "A", allow_negative_numbers = true, value_parser = number)]
    pub(crate) alpha: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Overwrite output files that exist already
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("watched").args(["event", "until"]).multiple(true))]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method (see `noslip list methods`), instead of the scene's
    #[arg(long, value_name = "M")]
    pub(crate) method: Option<String>,
    /// Keep every N-th node in the output file
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = count)]
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
    #[arg(long, value_name = "TOL", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tolerance: Option<f64>,
    /// Divide a step that fails, or that does not resolve the motion, into parts; every step then takes the time of three steps
    #[arg(long)]
    pub(crate) substep: bool,
    /// Save the run to this file at intervals, so that --resume can continue the run
    #[arg(long, value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Save the run every N steps
    #[arg(long, value_name = "N", default_value_t = 1_000_000, allow_negative_numbers = true, value_parser = count,
          requires = "checkpoint")]
    pub(crate) checkpoint_every: u64,
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
    #[arg(long, value_name = "N", default_value_t = harness::EVENT_SAMPLES, allow_negative_numbers = true,
          value_parser = event_samples, requires = "watched")]
    pub(crate) event_samples: u32,
}

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
    #[arg(long, value_name = "N", default_value_t = 10_000_000, allow_negative_numbers = true, value_parser = count,
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
    #[arg(value_name = "SCENE")]
    pub(crate) scene: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Methods, separated by commas [default: all]
    #[arg(long, value_name = "M,..", value_delimiter = ',')]
    pub(crate) methods: Option<Vec<String>>,
    /// Duration [s] [default: the scene's, at most 20 s, shortened until the reference is known to 1e-12]
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    pub(crate) duration: Option<f64>,
    /// Weight of `dla-alpha`, from 0 to 1
    #[arg(long, value_name = "A", allow_negative_numbers = true, value_parser = number)]
    pub(crate) alpha: Option<f64>,
    /// Longest run of a method [s]; a method that has fewer than six points may take ten times as long
    #[arg(long, value_name = "S", default_value_t = 0.1, allow_negative_numbers = true, value_parser = at_most_a_day)]
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
pub(crate) struct EquilibriaArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method whose steps are linearised: of the family dla, rk4 or rk4-reduced, instead of the scene's
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
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub(crate) loops: Option<u64>,
    /// Draw the turn of each loop against the heading before the loop: .svg
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct LyapunovArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Method that can be differentiated: the families dla, gauss, lobatto3, lobatto4, energy2, energy4, rk4-reduced
    #[arg(long, value_name = "M", default_value = "gauss8")]
    pub(crate) method: String,
    /// Number of exponents, the largest first [default: all]
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = count, conflicts_with = "map")]
    pub(crate) exponents: Option<u64>,
    /// Time to integrate before the exponents are measured, so that the motion settles [s] [default: a tenth of the
    /// duration]
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = not_negative)]
    pub(crate) settle: Option<f64>,
    /// Energy of the start [J]: the velocities of the start are scaled to have this energy
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = number)]
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
    #[arg(long, value_name = "N", default_value_t = 12, allow_negative_numbers = true, value_parser = count)]
    pub(crate) starts: u64,
    /// Energy of all starts [J], instead of the scene's
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = number)]
    pub(crate) energy: Option<f64>,
    /// Write the crossings as numbers (.csv) or a picture (.svg), by the ending of the name
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
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
pub(crate) struct EnsembleArguments {
    /// A sweep file, which names a scene and the keys that vary
    #[arg(value_name = "SWEEP")]
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

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// Scene files, names of bundled scenes, or - for the standard input
    #[arg(value_name = "SCENE", required = true)]
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
    #[arg(value_name = "SCENE")]
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

#[derive(Debug, Args)]
pub(crate) struct PlotArguments {
    /// A file of a run, .csv or .npz; a scene file, the name of a bundled scene, or - for a scene on the standard input
    #[arg(value_name = "FILE_OR_SCENE")]
    pub(crate) input: String,
    #[command(flatten)]
    pub(crate) set: Settings,
    /// Methods of the runs of a scene, separated by commas [default: the scene's]
    #[arg(long, value_name = "M,..", value_delimiter = ',')]
    pub(crate) methods: Option<Vec<String>>,
    /// Largest step [s], instead of the scene's
    #[arg(long, value_name = "H", allow_negative_numbers = true, value_parser = number)]
    pub(crate) step: Option<f64>,
    /// Duration [s], instead of the scene's
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    pub(crate) duration: Option<f64>,
    /// Weight of `dla-alpha`, from 0 to 1
    #[arg(long, value_name = "A", allow_negative_numbers = true, value_parser = number)]
    pub(crate) alpha: Option<f64>,
    /// Columns to draw, separated by commas; `path` is the path [default: the path, velocities, heading, energy,
    /// constraint and reaction]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    pub(crate) columns: Option<Vec<String>>,
    /// Width and height, in cm, mm or in
    #[arg(long, value_name = "WxH", default_value = "17x20cm")]
    pub(crate) size: Size,
    /// Resolution of a .png, in pixels per inch
    #[arg(long, value_name = "N", default_value_t = 300, allow_negative_numbers = true, value_parser = dpi)]
    pub(crate) dpi: u32,
    /// The picture: .svg, .png or .pdf, by the ending [default: the name of the scene or file, .svg]
    #[arg(long, value_name = "PICTURE")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite a picture that exists already
    #[arg(long)]
    pub(crate) force: bool,
}

/// Width and height (cm).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Size(pub(crate) [f64; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let units = [("cm", 1.0), ("mm", 0.1), ("in", 2.54)];
        let found = units.iter().find_map(|(unit, length)| Some((text.trim().strip_suffix(unit)?, length)));
        let sides = found.and_then(|(sides, unit)| Some((sides.split_once('x')?, unit)));
        let length = |side: &str, unit: f64| side.trim().parse::<f64>().ok().map(|side| side * unit);
        let size = sides.and_then(|((width, height), unit)| Some([length(width, *unit)?, length(height, *unit)?]));
        let fits = |size: &[f64; 2]| size.iter().all(|side| (3.0..=200.0).contains(side));
        size.filter(fits).map(Self).ok_or_else(|| {
            "accepted are a width and a height, for example 16x9cm, 160x90mm or 6.3x3.5in, each from \
                3 to 200 cm"
                .to_owned()
        })
    }
}

fn dpi(text: &str) -> Result<u32, &'static str> {
    let dpi = text.trim().parse().ok().filter(|dpi| (30..=1200).contains(dpi));
    dpi.ok_or("accepted is a whole number from 30 to 1200")
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
    #[arg(long, value_name = "SIZE", allow_negative_numbers = true, value_parser = not_negative)]
    pub(crate) within: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

fn count(text: &str) -> Result<u64, &'static str> {
    let count = text.trim().parse().ok().filter(|count| *count > 0);
    count.ok_or("accepted is a whole number of 1 or more")
}

/// A step is looked at in so many parts at most, each of which is a step of the method.
const MOST_SAMPLES: u32 = 10_000;

fn event_samples(text: &str) -> Result<u32, String> {
    let samples = text.trim().parse().ok().filter(|samples| (1..=MOST_SAMPLES).contains(samples));
    samples.ok_or_else(|| format!("accepted is a whole number from 1 to {MOST_SAMPLES}"))
}

fn number(text: &str) -> Result<f64, &'static str> {
    text.trim().parse().map_err(|_| "not a number; accepted are numbers like 0.05 and 1e-3")
}

fn not_negative(text: &str) -> Result<f64, &'static str> {
    let number = number(text).ok().filter(|number| *number >= 0.0 && number.is_finite());
    number.ok_or("accepted is a number of 0 or more")
}

/// A day, in s.
const DAY: f64 = 86400.0;

fn at_most_a_day(text: &str) -> Result<f64, &'static str> {
    let seconds = number(text).ok().filter(|number| *number > 0.0 && *number <= DAY);
    seconds.ok_or("accepted is a number greater than 0 and at most 86400")
}
