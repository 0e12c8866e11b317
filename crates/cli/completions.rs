//! `noslip completions` and `noslip man`: from the same arguments that are parsed.

use crate::args::Arguments;
use crate::error::CliError;
use crate::terminal;
use clap::CommandFactory;
use clap_complete::Shell;

/// Prints the completions of a shell.
pub(crate) fn completions(shell: Shell) -> Result<(), CliError> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "noslip", &mut text);
    terminal::print(&String::from_utf8_lossy(&text))
}

/// Prints a page for `man`, of the program or of one of its commands.
pub(crate) fn man(command: Option<&str>) -> Result<(), CliError> {
    let mut all = Arguments::command();
    // The names of the commands are then whole: `noslip run`.
    all.build();
    let page = match command {
        None => Some(&all),
        Some(name) => all.find_subcommand(name).filter(|command| !command.is_hide_set()),
    };
    let Some(page) = page else {
        let names: Vec<&str> =
            all.get_subcommands().filter(|command| !command.is_hide_set()).map(clap::Command::get_name).collect();
        let problem =
            format!("unknown command `{}`; the commands are {}", command.unwrap_or_default(), names.join(", "));
        return Err(CliError::Request(problem));
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page.clone()).render(&mut text).map_err(CliError::Output)?;
    terminal::print(&String::from_utf8_lossy(&text))
}
