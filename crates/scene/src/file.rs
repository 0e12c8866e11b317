use crate::bundled;
use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::suggest;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// The largest file that is read, in bytes: a path that leads to an endless device must not fill the memory.
const LARGEST: u64 = 16 << 20;

/// The text of the scene file at `origin`, or of the standard input for `-`.
pub(crate) fn read(origin: &str) -> Result<String, SceneError> {
    let unreadable = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => not_found(origin),
        io::ErrorKind::IsADirectory => SceneError::Directory { origin: origin.to_owned() },
        kind => SceneError::Unreadable { origin: origin.to_owned(), kind, message: error.to_string() },
    };
    let mut bytes = Vec::new();
    if origin == "-" {
        io::stdin().lock().take(LARGEST + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    } else {
        // Not every system refuses to open a directory in words that say so.
        let path = path_of(origin);
        if fs::metadata(&path).map_err(unreadable)?.is_dir() {
            return Err(SceneError::Directory { origin: origin.to_owned() });
        }
        let file = File::open(&path).map_err(unreadable)?;
        file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    }
    if bytes.len() as u64 > LARGEST {
        return Err(SceneError::TooLarge { origin: origin.to_owned(), limit: LARGEST });
    }
    String::from_utf8(bytes).map_err(|error| {
        let start = error.utf8_error().valid_up_to();
        not_utf8(origin, error.as_bytes(), start)
    })
}

/// The text of a file beside a scene, or what the operating system says.
pub(crate) fn text(path: &Path) -> Result<String, String> {
    let mut text = String::new();
    // A device or a pipe might never end.
    if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(format!("{}: not a file", path.display()));
    }
    let file = File::open(path).map_err(|error| format!("{}: {error}", path.display()))?;
    file.take(LARGEST + 1).read_to_string(&mut text).map_err(|error| format!("{}: {error}", path.display()))?;
    if text.len() as u64 > LARGEST {
        return Err(format!("{}: larger than {LARGEST} bytes", path.display()));
    }
    Ok(text)
}

/// What stands for the byte 0 of a path that is not UTF-8; the other bytes follow. They are for private use, and in no name of a file.
const BYTES: u32 = 0x10_ff00;

/// The name of a scene, by the path of its file: a text, also where the path is none.
#[must_use]
pub fn name_of_path(path: &OsStr) -> String {
    let chunks = path.as_encoded_bytes().utf8_chunks();
    let bytes =
        |bytes: &[u8]| bytes.iter().filter_map(|byte| char::from_u32(BYTES + u32::from(*byte))).collect::<String>();
    chunks.map(|chunk| chunk.valid().to_owned() + &bytes(chunk.invalid())).collect()
}

/// The path in such a name.
#[must_use]
pub fn path_of(name: &str) -> PathBuf {
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStringExt;
        let mut bytes = Vec::with_capacity(name.len());
        for letter in name.chars() {
            match u32::from(letter).checked_sub(BYTES).and_then(|byte| u8::try_from(byte).ok()) {
                Some(byte) => bytes.push(byte),
                None => bytes.extend(letter.encode_utf8(&mut [0; 4]).bytes()),
            }
        }
        PathBuf::from(std::ffi::OsString::from_vec(bytes))
    }
    #[cfg(not(unix))]
    PathBuf::from(name)
}

/// A file that the text of another one names, seen from the folder of that one.
pub(crate) fn beside(origin: &str, path: &str) -> PathBuf {
    path_of(origin).parent().map_or_else(|| path.into(), |folder| folder.join(path))
}

/// The scene that a sweep names: a bundled one, or a file, seen from the folder of the sweep, or else from the working folder.
pub(crate) fn scene_of_sweep(origin: &str, name: &str) -> String {
    let place = beside(origin, name);
    if bundled::named(name).is_none() && place.exists() { name_of_path(place.as_os_str()) } else { name.to_owned() }
}

/// The existing files that a scene or sweep reads: its own file, the file of a sweep's scene, and files of points. A bundled scene has
/// none.
#[must_use]
pub fn files_of(name_or_path: &str) -> Vec<PathBuf> {
    let (mut files, scene) = files_in(name_or_path);
    // A sweep has no sweep in it.
    files.extend(scene.map_or_else(Vec::new, |scene| files_in(&scene_of_sweep(name_or_path, &scene)).0));
    files
}

/// The file of this name or path with its files of points, and the scene that a sweep names.
fn files_in(name_or_path: &str) -> (Vec<PathBuf>, Option<String>) {
    let own = path_of(name_or_path);
    if name_or_path == "-" || bundled::named(name_or_path).is_some() || !own.is_file() {
        return (Vec::new(), None);
    }
    let table: Table = text(&own).ok().and_then(|text| text.parse().ok()).unwrap_or_default();
    let mut files = vec![own];
    table.values().for_each(|value| points_of(name_or_path, value, &mut files));
    (files, table.get("scene").and_then(Value::as_str).map(str::to_owned))
}

/// Adds the files of points that a value names, at any depth.
fn points_of(origin: &str, value: &Value, files: &mut Vec<PathBuf>) {
    match value {
        Value::Array(values) => values.iter().for_each(|value| points_of(origin, value, files)),
        Value::Table(table) => {
            if let (Some(Value::String(file)), true) = (table.get("file"), table.contains_key("columns")) {
                files.push(beside(origin, file));
            }
            table.values().for_each(|value| points_of(origin, value, files));
        }
        _ => {}
    }
}

fn not_found(origin: &str) -> SceneError {
    // `turnarond.toml` and `scenes/turnaround.toml` are near `turnaround` too.
    let stem = Path::new(origin).file_stem().and_then(|stem| stem.to_str()).unwrap_or(origin);
    SceneError::NotFound {
        origin: origin.to_owned(),
        suggestion: suggest::nearest(stem, bundled::names()),
        bundled: bundled::names().collect(),
    }
}

/// The error of bytes of which the one at `start` is the first that is not UTF-8.
fn not_utf8(origin: &str, bytes: &[u8], start: usize) -> SceneError {
    // The text before `start` is valid, so that the replacement characters leave the places in it as they are.
    let text = String::from_utf8_lossy(bytes);
    let replacement = char::REPLACEMENT_CHARACTER.len_utf8();
    let fault = Fault::new(SceneError::Encoding, "", "the file is not UTF-8", "TOML text in UTF-8")
        .found(bytes.get(start).map(|byte| format!("the byte 0x{byte:02x}")));
    Document { origin, text: &text }.fail(&(start..start + replacement), None, fault)
}
