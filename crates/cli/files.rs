use crate::error::CliError;
use crate::lock::{Lock, locked};
use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, TempPath};

/// Refuses, before the work begins, a file that could not be written at its end.
pub(crate) fn check_file(path: &Path, overwrite: bool) -> Result<(), CliError> {
    refuse_existing(path, overwrite)?;
    if path.is_dir() || path.to_string_lossy().ends_with(std::path::is_separator) {
        return Err(CliError::Write { path: path.to_owned(), source: ErrorKind::IsADirectory.into() });
    }
    // A rename would put a file in the place of a device or a pipe.
    if path.metadata().is_ok_and(|existing| !existing.is_file()) {
        let source = Error::new(ErrorKind::InvalidInput, "the path is not a regular file");
        return Err(CliError::Write { path: path.to_owned(), source });
    }
    // The way to learn whether a folder can be written in is to write in it.
    temporary(path).map(drop)
}

/// The same for a folder.
pub(crate) fn check_folder(path: &Path, overwrite: bool) -> Result<(), CliError> {
    refuse_existing(path, overwrite)?;
    if path.exists() && !path.is_dir() {
        return Err(CliError::Write { path: path.to_owned(), source: ErrorKind::NotADirectory.into() });
    }
    temporary(path).map(drop)
}

fn refuse_existing(path: &Path, overwrite: bool) -> Result<(), CliError> {
    match path.symlink_metadata() {
        Ok(_) if !overwrite => Err(CliError::Exists { path: path.to_owned() }),
        // Such as a name that is too long; of a folder that is not there, `temporary` says more.
        Err(source) if source.kind() != ErrorKind::NotFound && parent(path).is_dir() => {
            Err(CliError::Write { path: path.to_owned(), source })
        }
        _ => Ok(()),
    }
}

/// Writes a file that appears whole or not at all: under another name beside it, renamed when it is complete.
pub(crate) fn write_whole(
    path: &Path,
    overwrite: bool,
    content: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), Error>,
) -> Result<(), CliError> {
    check_file(path, overwrite)?;
    let failed = |source| CliError::Write { path: path.to_owned(), source };
    // What is overwritten through a link is the file that the link leads to.
    let target = if overwrite { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() };
    let mut file = temporary(&target)?;
    {
        let mut buffer = BufWriter::new(file.as_file_mut());
        content(&mut buffer).and_then(|()| buffer.flush()).map_err(failed)?;
    }
    file.as_file().sync_all().map_err(failed)?;
    let kept = if overwrite { file.persist(target) } else { file.persist_noclobber(target) };
    kept.map(|_| ()).map_err(|error| failed(error.error))
}

/// The file `NAME.noslip-new` beside `path`, that is removed unless it is renamed; with the usual rights of a new file. The name is
/// always the same, so that a process that is killed leaves one file at most, which the next one takes.
fn temporary(path: &Path) -> Result<NamedTempFile, CliError> {
    let folder = parent(path);
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".noslip-new");
    let new = folder.join(name);
    let failed = |source| CliError::Folder { path: path.to_owned(), folder: folder.clone(), source };
    let file = match locked(&new).map_err(failed)? {
        Lock::Held(file) | Lock::Unlocked(file) => file,
        Lock::Busy => return Err(CliError::Busy { path: new, out: path.to_owned() }),
    };
    file.set_len(0).map_err(failed)?;
    Ok(NamedTempFile::from_parts(file, TempPath::try_from_path(new).map_err(failed)?))
}

fn parent(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}
