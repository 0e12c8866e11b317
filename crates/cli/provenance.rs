use crate::command_line::CommandLine;
use crate::error::CliError;
use crate::files::write_whole;
use crate::program;
use scene::{AnyScene, Column};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The provenance of a file, and the units of its columns: a document of "CSV on the Web" (W3C 2015), whose notes name the program, the
/// command that makes the file again, and the scene.
#[derive(Debug, Clone)]
pub(crate) struct Provenance {
    title: String,
    notes: Value,
}

impl Provenance {
    /// The provenance of rows that a command computes; `notes` is an object with further notes.
    pub(crate) fn new(title: &str, command: Option<&CommandLine>, mut notes: Value) -> Self {
        notes["program"] = json!(format!("noslip {}", program::version()));
        notes["instructions"] = json!(program::instructions());
        if let Some(command) = command {
            notes["command"] = json!(command.to_string());
        }
        Self { title: title.to_owned(), notes }
    }

    /// The provenance of rows that are computed on a scene: its title, and its text with all numbers as they were used, including changes
    /// by the command line.
    pub(crate) fn on(scene: &AnyScene, command: Option<&CommandLine>, mut notes: Value) -> Self {
        if let Ok(text) = scene.to_toml() {
            notes["scene"] = json!(text);
        }
        Self::new(scene.title(), command, notes)
    }

    /// Adds how far the work came, if a signal ended it.
    pub(crate) fn interrupted(mut self, made: Option<&str>) -> Self {
        made.into_iter().for_each(|made| self.notes["interrupted"] = json!(made));
        self
    }

    /// The document of a file of that name, with a newline at its end.
    pub(crate) fn document(&self, name: &str, columns: &[Value]) -> String {
        let document = json!({
            "@context": "http://www.w3.org/ns/csvw",
            "url": name,
            "dc:title": self.title,
            "notes": [self.notes],
            "tableSchema": {"columns": columns},
        });
        format!("{document:#}\n")
    }

    /// Writes the document of a file of text beside it.
    pub(crate) fn write_beside(&self, path: &Path, columns: &[Value]) -> Result<(), CliError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let document = self.document(&name, columns);
        write_whole(&metadata_of(path), true, |file| file.write_all(document.as_bytes()))
    }
}

/// Where the provenance of a file of text is: beside it, as "CSV on the Web" has it.
pub(crate) fn metadata_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push("-metadata.json");
    path.with_file_name(name)
}

/// Columns as a document describes them.
pub(crate) fn described(columns: &[Column]) -> Vec<Value> {
    let one = |column: &Column| {
        let datatype = if column.whole { "integer" } else { "double" };
        object(&label(column), &column.name, &column.unit, datatype)
    };
    columns.iter().map(one).collect()
}

/// The description of a column by its heading, `NAME [UNIT]` or `NAME`, and the type of its fields, by its name in XML Schema; a name in the
/// document has no spaces.
pub(crate) fn headed(heading: &str, datatype: &str) -> Value {
    let (name, unit) = named(heading);
    object(heading, &name.replace(' ', "_"), unit.unwrap_or_default(), datatype)
}

fn object(title: &str, name: &str, unit: &str, datatype: &str) -> Value {
    let mut object = json!({"titles": title, "name": name, "datatype": datatype});
    if !unit.is_empty() {
        object["schema:unitText"] = json!(unit);
    }
    object
}

/// A column as a header shows it.
pub(crate) fn label(Column { name, unit, .. }: &Column) -> String {
    if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") }
}

/// The name and the unit in such a heading; a unit may have brackets of its own.
pub(crate) fn named(heading: &str) -> (&str, Option<&str>) {
    let mut depth = 0;
    let begin = heading.char_indices().rev().find(|(_, letter)| {
        depth += i32::from(*letter == ']') - i32::from(*letter == '[');
        depth <= 0
    });
    let split = begin.and_then(|(at, _)| Some((heading[..at].strip_suffix(' ')?, heading[at..].strip_suffix(']')?)));
    match split {
        Some((name, unit)) => (name, Some(&unit[1..])),
        None => (heading, None),
    }
}
