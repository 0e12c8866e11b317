use scene::Column;
use serde_json::{Value, json};

/// What made a file, and the units of its columns: a document of "CSV on the Web" (W3C 2015), whose notes name the program, the command
/// that makes the file again, and the scene.
#[derive(Debug, Clone)]
pub(crate) struct Provenance {
    title: String,
    notes: Value,
}

impl Provenance {
    /// Of rows that a command computes; `notes` are an object with whatever else is to be told.
    pub(crate) fn new(title: &str, command: &[String], mut notes: Value) -> Self {
        notes["program"] = json!(format!("noslip {}", env!("CARGO_PKG_VERSION")));
        notes["command"] = json!(command.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" "));
        Self { title: title.to_owned(), notes }
    }

    /// The document of a file of that name.
    pub(crate) fn document(&self, name: &str, columns: &[Column]) -> Value {
        let columns = columns.iter().map(|column| {
            let mut object = json!({"titles": label(column), "name": column.name, "datatype": datatype(column)});
            if !column.unit.is_empty() {
                object["schema:unitText"] = json!(column.unit);
            }
            object
        });
        json!({
            "@context": "http://www.w3.org/ns/csvw",
            "url": name,
            "dc:title": self.title,
            "notes": [self.notes],
            "tableSchema": {"columns": columns.collect::<Vec<_>>()},
        })
    }
}

/// A column as a header shows it.
pub(crate) fn label(Column { name, unit, .. }: &Column) -> String {
    if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") }
}

/// The type of the numbers of a column, by its name in XML Schema.
fn datatype(column: &Column) -> &'static str {
    if column.whole { "integer" } else { "double" }
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
