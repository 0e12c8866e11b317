use crate::args::Settings;
use scene::RunSettings;

/// A command line that makes a file again, word by word.
#[derive(Debug, Clone)]
pub(crate) struct CommandLine(Vec<String>);

impl CommandLine {
    /// `noslip COMMAND SCENE`, with one `--set` for each setting.
    pub(crate) fn of(command: &str, scene: &str, set: &Settings) -> Self {
        let line = Self(["noslip", command, scene].map(str::to_owned).to_vec());
        set.set.iter().fold(line, |line, setting| line.with("--set", setting))
    }

    /// A flag and its value.
    #[expect(clippy::needless_pass_by_value, reason = "callers have numbers and displays as often as references")]
    pub(crate) fn with(mut self, flag: &str, value: impl ToString) -> Self {
        self.0.extend([flag.to_owned(), value.to_string()]);
        self
    }

    /// A flag and a number with all of its digits.
    pub(crate) fn number(self, flag: &str, value: f64) -> Self {
        self.with(flag, format!("{value:?}"))
    }

    /// A flag and its value; nothing for `None`.
    pub(crate) fn maybe(self, flag: &str, value: Option<impl ToString>) -> Self {
        value.into_iter().fold(self, |line, value| line.with(flag, value))
    }

    /// As [`Self::number`]; nothing for `None`.
    pub(crate) fn maybe_number(self, flag: &str, value: Option<f64>) -> Self {
        value.into_iter().fold(self, |line, value| line.number(flag, value))
    }

    /// A flag without a value, if it was given.
    pub(crate) fn flag(mut self, flag: &str, given: bool) -> Self {
        self.0.extend(given.then(|| flag.to_owned()));
        self
    }

    /// The method, the step (s) and the duration that were taken; backward in time if the step is negative.
    pub(crate) fn run(self, run: &RunSettings, step: f64) -> Self {
        let duration = run.duration.copysign(step);
        let line = self.with("--method", &run.method).number("--step", step.abs()).number("--duration", duration);
        line.maybe_number("--alpha", run.alpha)
    }
}

impl std::fmt::Display for CommandLine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let words: Vec<String> = self.0.iter().map(|word| quoted(word)).collect();
        f.write_str(&words.join(" "))
    }
}

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,+:@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
