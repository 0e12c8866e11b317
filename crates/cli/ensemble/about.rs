use super::contents;
use super::members::Summed;
use super::result::failed;
use crate::args::Settings;
use crate::command_line::CommandLine;
use crate::error::CliError;
use crate::files::{read_text, write_whole};
use crate::format::Format;
use crate::program;
use crate::provenance::{Provenance, described, headed};
use scene::{Column, Sweep};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::time::Duration;

/// The largest file on a sweep that is read (bytes).
const LARGEST: u64 = 1 << 26;
/// How often, and how many times, it is tried to write one that another process writes.
const OFTEN: Duration = Duration::from_millis(10);
const PATIENCE: u32 = 500;

/// The description of a sweep, beside its members or their summary: all that a result needs besides its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct About {
    /// The first line of its files of rows: what tells it from other sweeps and other versions of the program.
    pub(super) identity: String,
    /// Its parts that tell one from another sweep, from another version of the program, and from other machines.
    pub(super) contents: String,
    pub(super) version: String,
    pub(super) instructions: String,
    /// The file of the sweep, as it was named.
    pub(super) sweep: String,
    /// Settings, `KEY=VALUE`, that replace values of its scene.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    settings: Vec<String>,
    /// Its scene.
    pub(super) scene: String,
    pub(super) title: String,
    pub(super) method: String,
    /// The step (s).
    pub(super) step: f64,
    /// The duration (s).
    pub(super) duration: f64,
    /// The keys that vary.
    pub(super) keys: Vec<String>,
    pub(super) members: u64,
    /// Name, unit and whether it has whole numbers, of every column.
    columns: Vec<(String, String, bool)>,
    notes: Value,
}

impl About {
    /// The description of a sweep from the file `file`.
    pub(super) fn new((file, set): (&str, &Settings), sweep: &Sweep, summed: &Summed, identity: &str) -> Self {
        let (scene, run) = (&sweep.scene, sweep.scene.run());
        let mut notes = json!({
            "method": run.method, "step": run.actual_step(), "duration": run.duration, "sweep": sweep.file,
        });
        if let Ok(text) = scene.to_toml() {
            notes["scene"] = json!(text);
        }
        Self {
            identity: identity.to_owned(),
            contents: contents(sweep),
            version: program::version(),
            instructions: program::instructions(),
            sweep: file.to_owned(),
            settings: set.set.iter().map(ToString::to_string).collect(),
            scene: scene.name().to_owned(),
            title: scene.title().to_owned(),
            method: run.method.clone(),
            step: run.actual_step(),
            duration: run.duration,
            keys: sweep.keys().map(ToString::to_string).collect(),
            members: sweep.count(),
            columns: header(sweep, summed)
                .into_iter()
                .map(|Column { name, unit, whole }| (name, unit, whole))
                .collect(),
            notes,
        }
    }

    /// The columns of the result.
    pub(super) fn columns(&self) -> Vec<Column> {
        self.columns.iter().map(|(name, unit, whole)| Column { whole: *whole, ..Column::new(name, unit) }).collect()
    }

    /// The metadata of a result: the command that makes it at once, the sweep and its scene; and its columns, of which the last tells the
    /// members that failed.
    pub(super) fn metadata(&self, out: &Path, format: Format) -> String {
        let name = out.file_name().unwrap_or_default().to_string_lossy();
        let command = CommandLine::of("ensemble", &self.sweep, &Settings::default());
        let command = self.settings.iter().fold(command, |command, setting| command.with("--set", setting));
        let command = command.with("--out", out.display());
        let provenance = Provenance::new(&self.title, Some(&command), self.notes.clone());
        let mut columns = described(&self.columns());
        columns.extend(if format.is_text() { vec![headed("error", "string")] } else { described(&[failed()]) });
        provenance.document(&name, &columns)
    }

    /// Reads it from a file beside parts; `None` if the file is another one, or damaged.
    pub(super) fn read(path: &Path) -> Option<Self> {
        let text = read_text(path, LARGEST).ok()?;
        let about: Self = serde_json::from_str(&text).ok()?;
        (about.text()? == text).then_some(about)
    }

    /// The text of the file, which has a checksum of all that it says.
    fn text(&self) -> Option<String> {
        let mut about = serde_json::to_value(self).ok()?;
        about["checksum"] = json!(format!("{:08x}", crc32fast::hash(about.to_string().as_bytes())));
        Some(format!("{about:#}\n"))
    }

    /// Writes it beside parts, whole or not at all; processes that do so at the same time write the same.
    pub(super) fn write(&self, path: &Path) -> Result<(), CliError> {
        let text = self.text().unwrap_or_default();
        for _ in 0..PATIENCE {
            if Self::read(path).as_ref() == Some(self) {
                return Ok(());
            }
            match write_whole(path, true, |file| file.write_all(text.as_bytes())) {
                Err(CliError::Busy { .. }) => std::thread::sleep(OFTEN),
                outcome => return outcome,
            }
        }
        write_whole(path, true, |file| file.write_all(text.as_bytes()))
    }
}

/// Names and units of the columns. Those of the keys have no unit: a key may be any number of the scene.
fn header(sweep: &Sweep, summed: &Summed) -> Vec<Column> {
    let exponent = sweep.exponent.then(|| Column::new("exponent", "1/s"));
    let keys = sweep.keys().map(|key| Column::new(key, ""));
    std::iter::once(Column::whole("member")).chain(keys).chain(summed.columns()).chain(exponent).collect()
}
