//! The command line of noslip, as a library: [`main`] is the program, [`call`] a command whose output its caller keeps, [`run`] a
//! run whose nodes its caller keeps, and [`plan`] the parts of a sweep.

mod account;
mod analysis;
mod args;
mod called;
mod chart_file;
mod check;
mod columns_file;
mod command_line;
mod compare;
mod coordinate;
mod cost;
mod diff;
mod effect_keys;
mod ensemble;
mod equilibria;
mod error;
mod facts;
mod file_roles;
mod files;
mod first;
mod format;
mod in_memory;
mod inspect;
mod interrupt;
mod json;
mod list;
mod lock;
mod lyapunov;
mod output;
#[cfg(feature = "parquet")]
mod parquet_file;
mod phase;
mod plane;
mod plot;
mod points_file;
mod precision;
mod precision_text;
mod program;
mod progress;
mod provenance;
mod resume;
mod row_verdict;
mod run;
mod run_report;
mod section;
mod stability;
mod stability_map;
mod starts;
mod substeps;
mod table;
mod terminal;
mod train;
mod trigger;

use args::{Arguments, Command};
use clap::{CommandFactory, Parser};
use error::CliError;
use std::process::ExitCode;

pub use called::{Caller, CommandOutput, ShownToCaller, call};
pub use ensemble::{SweepPlan, plan};
pub use in_memory::{Refusal, RunRequest, RunResult, check_times, run};
pub use program::{missing_instructions, wrong_processor};

/// The program: the command of its arguments, with its exit code.
#[must_use]
pub fn main() -> ExitCode {
    if let Some(problem) = wrong_processor() {
        terminal::say("error", &problem);
        return ExitCode::from(1);
    }
    ExitCode::from(obey(std::env::args_os()))
}

/// The long flags of a command; empty for an unknown command.
#[must_use]
pub fn flags(command: &str) -> Vec<String> {
    let program = Arguments::command();
    let flags = program.find_subcommand(command).into_iter().flat_map(clap::Command::get_arguments);
    flags.filter_map(|argument| argument.get_long().map(str::to_owned)).collect()
}

/// Does what the arguments say, the first of which is the name of the program, and gives the exit code.
fn obey(arguments: impl Iterator<Item = std::ffi::OsString>) -> u8 {
    if std::env::var_os("RAYON_NUM_THREADS").is_some() {
        // A thread pool made by a library may have thousands of threads.
        harness::analysis::prepare_threads();
    }
    let (outcome, done) = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => (command(arguments), 0),
        // The help and the version are no errors to anybody but clap.
        Err(usage) => {
            let done = if usage.use_stderr() { 2 } else { 0 };
            (terminal::print_usage(&usage), done)
        }
    };
    match outcome {
        Ok(()) => done,
        Err(error) => {
            terminal::fail(&error);
            called::note_busy(matches!(error, CliError::Busy { .. }));
            error.exit_code()
        }
    }
}

fn command(arguments: Arguments) -> Result<(), CliError> {
    match arguments.command {
        None => first::first(&arguments.job),
        Some(Command::Run(arguments)) => run_report::run_and_show(&arguments),
        Some(Command::Compare(arguments)) => compare::compare(&arguments),
        Some(Command::Precision(arguments)) => precision::precision(&arguments),
        Some(Command::Stability(arguments)) => stability::stability(&arguments),
        Some(Command::Cost(arguments)) => cost::cost(&arguments),
        Some(Command::Equilibria(arguments)) => equilibria::equilibria(&arguments),
        Some(Command::Phase(arguments)) => phase::phase(&arguments),
        Some(Command::Lyapunov(arguments)) => lyapunov::lyapunov(&arguments),
        Some(Command::Section(arguments)) => section::section(&arguments),
        Some(Command::Ensemble(arguments)) => ensemble::ensemble(&arguments),
        Some(Command::Merge(arguments)) => ensemble::merge(&arguments),
        Some(Command::Check(arguments)) => check::check(&arguments),
        Some(Command::Equations(arguments)) => check::equations(&arguments),
        Some(Command::List(arguments)) => list::list(&arguments),
        Some(Command::New(arguments)) => list::new(&arguments),
        Some(Command::Plot(arguments)) => plot::plot(&arguments),
        Some(Command::Diff(arguments)) => diff::diff(&arguments),
        Some(Command::Completions { shell }) => list::completions(shell),
        Some(Command::Man { command }) => list::man(command.as_deref()),
    }
}
