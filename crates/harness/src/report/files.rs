//! Writing a folder whole or not at all.

use super::ReportError;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// What the names of temporary files and folders start with.
const PREFIX: &str = ".report-";

/// Names fit for files, all different, also where case does not count.
pub(super) fn stems<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut stems: Vec<String> = Vec::new();
    for name in names {
        let fit: String = name
            .chars()
            .map(|c| if c.is_alphanumeric() || matches!(c, '-' | '_' | '.') { c } else { '-' })
            .take(60)
            .collect();
        let fit = match fit.trim_matches(['.', '-']) {
            "" => "scene",
            fit => fit,
        };
        let taken = |stem: &str| stems.iter().any(|other| other.to_lowercase() == stem.to_lowercase());
        let mut stem = fit.to_owned();
        let mut copy = 2;
        while taken(&stem) {
            stem = format!("{fit}-{copy}");
            copy += 1;
        }
        stems.push(stem);
    }
    stems
}

/// Writes files, given by name and content, into a folder, and returns where they are.
pub(super) fn write_all(
    directory: &Path,
    contents: &[(String, Vec<u8>)],
    overwrite: bool,
) -> Result<Vec<PathBuf>, ReportError> {
    match directory.symlink_metadata() {
        Ok(_) if overwrite => replace(directory, contents)?,
        Ok(_) => return Err(ReportError::Exists { path: directory.to_path_buf() }),
        Err(error) if error.kind() == io::ErrorKind::NotFound => create(directory, contents)?,
        Err(error) => return Err(failed(directory)(error)),
    }
    Ok(contents.iter().map(|(name, _)| directory.join(name)).collect())
}

/// Fills a temporary folder beside the wanted one, which a rename then makes appear with everything in it.
fn create(directory: &Path, contents: &[(String, Vec<u8>)]) -> Result<(), ReportError> {
    let parent = match directory.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let temporary = Builder::new().prefix(PREFIX).tempdir_in(parent).map_err(failed(directory))?;
    for (name, content) in contents {
        let write = || {
            let mut file = fs::File::create_new(temporary.path().join(name))?;
            file.write_all(content)?;
            // Some file systems find out that they are full only now.
            file.sync_all()
        };
        write().map_err(failed(&directory.join(name)))?;
    }
    fs::rename(temporary.path(), directory).map_err(failed(directory))?;
    // The folder has moved: nothing is left to remove under its temporary name.
    let _moved = temporary.keep();
    Ok(())
}

/// Writes every file beside the one it replaces, and renames them once all of them are there.
fn replace(directory: &Path, contents: &[(String, Vec<u8>)]) -> Result<(), ReportError> {
    let mut written: Vec<(PathBuf, NamedTempFile)> = Vec::with_capacity(contents.len());
    for (name, content) in contents {
        let target = directory.join(name);
        // A rename cannot replace a folder: better found out before the first file has been replaced.
        if target.is_dir() {
            return Err(failed(&target)(io::ErrorKind::IsADirectory.into()));
        }
        let mut builder = Builder::new();
        builder.prefix(PREFIX);
        // Temporary files are private unless told otherwise; these are going to be ordinary ones.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let write = || {
            let mut file = builder.tempfile_in(directory)?;
            file.write_all(content)?;
            file.as_file().sync_all()?;
            Ok(file)
        };
        let file = write().map_err(failed(&target))?;
        written.push((target, file));
    }
    // The page comes first in the list and last onto the disk: it then never shows pictures older than itself.
    for (target, file) in written.into_iter().rev() {
        file.persist(&target).map_err(|error| failed(&target)(error.error))?;
    }
    Ok(())
}

fn failed(path: &Path) -> impl FnOnce(io::Error) -> ReportError + use<> {
    let path = path.to_path_buf();
    move |source| ReportError::Io { path, source }
}
