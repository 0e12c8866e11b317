use crate::bundled;
use crate::document::Document;
use crate::error::SceneError;
use crate::fault::Fault;
use crate::suggest;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

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
        if fs::metadata(origin).map_err(unreadable)?.is_dir() {
            return Err(SceneError::Directory { origin: origin.to_owned() });
        }
        let file = File::open(origin).map_err(unreadable)?;
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
    let fault = Fault {
        variant: SceneError::Encoding,
        key: "",
        problem: "the file is not UTF-8".to_owned(),
        found: bytes.get(start).map(|byte| format!("the byte 0x{byte:02x}")),
        accepted: "TOML text in UTF-8".to_owned(),
        help: None,
    };
    Document { origin, text: &text }.fail(&(start..start + replacement), None, fault)
}
