use crate::called;
use crate::error::CliError;
use std::borrow::Cow;
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Prints a result. It is an error if standard output is full, but not if its reader has closed it: the rest of the work is done all the
/// same.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    let text = &*harmless(text);
    if called::keep_out(text) {
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    accept_closed(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// The text with its control signs written out: a title may not set the colours of a terminal, move its cursor, or turn the direction of
/// reading.
fn harmless(text: &str) -> Cow<'_, str> {
    let turns =
        |c: char| matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let breaks = |c: char| matches!(c, '\u{2028}' | '\u{2029}');
    let harmful = |c: char| c.is_control() && !matches!(c, '\n' | '\t') || turns(c) || breaks(c);
    if !text.contains(harmful) {
        return Cow::Borrowed(text);
    }
    let shown = |c: char| if harmful(c) { c.escape_unicode().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(shown).collect())
}

/// Standard output as a writer, for more than is held in memory.
#[derive(Debug)]
pub(crate) struct Out;

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if called::keep_out(&String::from_utf8_lossy(bytes)) { Ok(bytes.len()) } else { std::io::stdout().write(bytes) }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        std::io::stdout().flush()
    }
}

/// Prints a result on standard error, if standard output has another.
pub(crate) fn tell(text: &str) {
    if !called::keep_err(text) {
        // A failure to write there cannot be reported.
        let _ = std::io::stderr().write_all(text.as_bytes());
    }
}

/// Prints one JSON value.
pub(crate) fn print_json(value: &serde_json::Value) -> Result<(), CliError> {
    print(&format!("{value:#}\n"))
}

/// Prints a message of clap: help and version on standard output, errors on standard error.
pub(crate) fn print_usage(usage: &clap::Error) -> Result<(), CliError> {
    let keep = if usage.use_stderr() { called::keep_err } else { called::keep_out };
    if keep(&usage.to_string()) {
        return Ok(());
    }
    let printed = usage.print().and_then(|()| std::io::stdout().flush());
    if usage.use_stderr() { Ok(()) } else { accept_closed(printed) }
}

/// Prints why a command failed, in colours if standard error is a terminal.
pub(crate) fn fail(error: &CliError) {
    let coloured = console::colors_enabled_stderr() && std::env::var_os("NO_COLOR").is_none_or(|no| no.is_empty());
    let line = format!("error: {error}\n");
    if called::keep_err(&line) {
        return;
    }
    let level = console::Style::new().for_stderr().red().bold().force_styling(coloured).apply_to("error:");
    let message = match error {
        CliError::Scene(scene) if coloured => scene.finding().map(scene::SceneFinding::coloured),
        _ => None,
    };
    let line = format!("{level} {}\n", message.unwrap_or_else(|| harmless(&error.to_string()).into_owned()));
    // A failure to write there cannot be reported.
    let _ = std::io::stderr().write_all(line.as_bytes());
}

/// Prints a message on standard error. A failure to write there cannot be reported.
pub(crate) fn say(level: &str, message: &impl Display) {
    let line = format!("{level}: {message}\n");
    let line = harmless(&line);
    if !called::keep_err(&line) {
        let _ = std::io::stderr().write_all(line.as_bytes());
    }
}

fn accept_closed(written: std::io::Result<()>) -> Result<(), CliError> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(error)),
        _ => Ok(()),
    }
}
