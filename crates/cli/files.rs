use crate::error::CliError;
use crate::lock::{Lock, replaced};
use std::fs::File;
use std::io::{BufReader, BufWriter, Error, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, PathPersistError, TempPath};

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

/// Refuses, before the work begins, a folder that could not be written into.
pub(crate) fn check_folder(path: &Path, overwrite: bool) -> Result<(), CliError> {
    refuse_existing(path, overwrite)?;
    if path.exists() && !path.is_dir() {
        return Err(CliError::Write { path: path.to_owned(), source: ErrorKind::NotADirectory.into() });
    }
    temporary(path).map(drop)
}

/// A folder that a command writes into, made before the work: of two commands that begin at once, only one gets it. An empty folder is
/// removed on drop.
#[derive(Debug)]
pub(crate) struct ClaimedFolder(PathBuf);

impl ClaimedFolder {
    /// Claims the folder `path`.
    pub(crate) fn new(path: &Path, overwrite: bool) -> Result<Self, CliError> {
        check_folder(path, overwrite)?;
        match std::fs::create_dir(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists && !overwrite => {
                Err(CliError::Exists { path: path.to_owned() })
            }
            Err(source) if source.kind() != ErrorKind::AlreadyExists => {
                Err(CliError::Write { path: path.to_owned(), source })
            }
            _ => Ok(Self(path.to_owned())),
        }
    }

    /// Claims the first of `NAME`, `NAME-2`, .. that does not exist.
    pub(crate) fn first_free(name: &str) -> Result<Self, CliError> {
        let numbered = |k: u32| if k == 1 { name.to_owned() } else { format!("{name}-{k}") };
        for path in (1..).map(numbered).map(PathBuf::from) {
            match Self::new(&path, false) {
                Err(CliError::Exists { .. } | CliError::Busy { .. }) => {}
                other => return other,
            }
        }
        Err(CliError::Exists { path: PathBuf::from(name) })
    }

    /// The path of the folder.
    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for ClaimedFolder {
    fn drop(&mut self) {
        // A folder with a file in it stays.
        let _ = std::fs::remove_dir(&self.0);
    }
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
    // The file stays open, and with it locked, until it has its name.
    let (file, new) = filled(path, &target(path, overwrite), content)?.into_parts();
    named(new, &file, path, overwrite).map_err(|error| CliError::Write { path: path.to_owned(), source: error.error })
}

/// Renames a file to `path`. If it may overwrite an existing file, it takes over that file's permissions.
pub(crate) fn named(new: TempPath, file: &File, path: &Path, overwrite: bool) -> Result<(), PathPersistError> {
    let target = target(path, overwrite);
    if !overwrite {
        return new.persist_noclobber(target);
    }
    keep_mode(&target, file);
    new.persist(target)
}

/// Checks that an existing file has exactly this content, left by a command that was ended before its later work. Other content is refused.
pub(crate) fn as_written(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), Error>,
) -> Result<(), CliError> {
    let new = filled(path, path, content)?;
    let failed = |source| CliError::Read { path: path.to_owned(), source };
    match same(new.path(), path).map_err(failed)? {
        true => Ok(()),
        false => Err(CliError::Exists { path: path.to_owned() }),
    }
}

/// The temporary file of a target, with its content on the disk; errors name the path.
fn filled(
    path: &Path,
    target: &Path,
    content: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), Error>,
) -> Result<NamedTempFile, CliError> {
    let failed = |source| CliError::Write { path: path.to_owned(), source };
    let mut file = temporary(target)?;
    {
        let mut buffer = BufWriter::new(file.as_file_mut());
        content(&mut buffer).and_then(|()| buffer.flush()).map_err(failed)?;
    }
    file.as_file().sync_all().map_err(failed)?;
    Ok(file)
}

/// The file to write: if a link may be overwritten, the file that the link leads to.
fn target(path: &Path, overwrite: bool) -> PathBuf {
    if overwrite { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() }
}

/// Gives a new file the permissions of the file that it replaces, if possible.
fn keep_mode(old: &Path, new: &File) {
    if let Ok(old) = old.metadata() {
        let _ = new.set_permissions(old.permissions());
    }
}

/// Whether two files have the same bytes.
fn same(one: &Path, other: &Path) -> Result<bool, Error> {
    let [one, other] = [File::open(one)?, File::open(other)?];
    if one.metadata()?.len() != other.metadata()?.len() {
        return Ok(false);
    }
    let [one, other] = [one, other].map(|file| BufReader::with_capacity(1 << 16, file).bytes());
    for (a, b) in one.zip(other) {
        if a? != b? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The file `NAME.noslip-new` beside `path`, that is removed unless it is renamed; with the usual rights of a new file. The name is
/// always the same, so that a process that is killed leaves one file at most, which the next one replaces.
fn temporary(path: &Path) -> Result<NamedTempFile, CliError> {
    let (folder, new) = (parent(path), new_of(path));
    let failed = |source| CliError::Folder { path: path.to_owned(), folder: folder.clone(), source };
    let file = match replaced(&new).map_err(failed)? {
        Lock::Held(file, _) | Lock::Unlocked(file, _) => file,
        Lock::Busy => return Err(CliError::Busy { path: new, out: path.to_owned() }),
    };
    Ok(NamedTempFile::from_parts(file, TempPath::try_from_path(new).map_err(failed)?))
}

fn parent(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// The ending of the name of a file, in small letters; empty if the name has none.
pub(crate) fn ending(path: &Path) -> String {
    path.extension().map_or_else(String::new, |ending| ending.to_string_lossy().to_lowercase())
}

/// The name that a file has while it is written.
pub(crate) fn new_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".noslip-new");
    parent(path).join(name)
}

/// The canonical path of a file, equal for all paths of one file; if the file does not exist, its future path.
pub(crate) fn place(path: &Path) -> PathBuf {
    let beside = || Some(parent(path).canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(beside).unwrap_or_else(|| path.to_owned())
}

/// Reads the text of a file of at most `most` bytes: a device might never end.
pub(crate) fn read_text(path: &Path, most: u64) -> Result<String, Error> {
    let mut text = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut text)?;
    let refused = |problem: String| Error::new(ErrorKind::InvalidData, problem);
    if text.len() as u64 > most {
        return Err(refused(format!("larger than {most} bytes")));
    }
    String::from_utf8(text).map_err(|error| refused(error.to_string()))
}
