//! The command line of noslip.

mod args;
mod compare;
mod error;
mod files;
mod inspect;
mod job;
mod json;
mod progress;
mod run;
mod table;
mod terminal;
mod trajectory_file;

use args::{Arguments, Command};
use clap::Parser;
use error::CliError;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        None => job::main_job(&arguments.job),
        Some(Command::Run(arguments)) => run::run(&arguments),
        Some(Command::Compare(arguments)) => compare::compare(&arguments),
        Some(Command::Check(arguments)) => inspect::check(&arguments),
        Some(Command::List(arguments)) => inspect::list(&arguments),
        Some(Command::New(arguments)) => inspect::new(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever reads our output has seen enough.
        Err(CliError::ReaderGone) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            error.exit_code()
        }
    }
}
