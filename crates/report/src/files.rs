//! The files of a report: their names, and how they come into a folder.

use super::{Numbers, ReportError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// What the names of temporary files start with.
const PREFIX: &str = ".report-";

/// Names fit for files, all different, also where case does not count.
pub(crate) fn stems<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut stems: Vec<String> = Vec::new();
    let fits = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_' | '.') { c } else { '-' };
    for name in names {
        let fit: String = name.chars().map(fits).take(60).collect();
        let fit = match fit.trim_matches(['.', '-']) {
            "" => "scene",
            fit => fit,
        };
        let taken = |stem: &String| stems.iter().any(|other| other.to_lowercase() == stem.to_lowercase());
        let copies = (2..).map(|copy| format!("{fit}-{copy}"));
        stems.extend(std::iter::once(fit.to_owned()).chain(copies).find(|stem| !taken(stem)));
    }
    stems
}

/// Files of numbers with their names.
pub(crate) fn numbered(name: &str, numbers: &[Numbers]) -> impl Iterator<Item = (String, Vec<u8>)> {
    numbers.iter().map(move |file| (format!("{name}.{}", file.ending), file.text.clone().into_bytes()))
}

/// Writes files, given by name and content, into a folder, and returns where they are: every file beside the one that it replaces, and
/// renamed once all of them are there.
pub(crate) fn replace(directory: &Path, contents: Vec<(String, Vec<u8>)>) -> Result<Vec<PathBuf>, ReportError> {
    let mut written: Vec<(PathBuf, NamedTempFile)> = Vec::with_capacity(contents.len());
    for (name, content) in contents {
        let target = directory.join(name);
        // A rename cannot replace a folder: better found out before the first file has been replaced.
        if target.is_dir() {
            return Err(failed(target, io::ErrorKind::IsADirectory.into()));
        }
        match filled(directory, &content) {
            Ok(file) => written.push((target, file)),
            Err(error) => return Err(failed(target, error)),
        }
    }
    let targets = written.iter().map(|(target, _)| target.clone()).collect();
    // The page comes first in the list and last onto the disk: it then never shows pictures older than itself.
    for (target, file) in written.into_iter().rev() {
        file.persist(&target).map_err(|error| failed(target, error.error))?;
    }
    Ok(targets)
}

fn filled(directory: &Path, content: &[u8]) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX);
    // Temporary files are private unless told otherwise; these are going to be ordinary ones.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(directory)?;
    file.write_all(content)?;
    // Some file systems find out that they are full only now.
    file.as_file().sync_all()?;
    Ok(file)
}

fn failed(path: PathBuf, source: io::Error) -> ReportError {
    ReportError::Io { path, source }
}
