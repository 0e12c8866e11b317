//! Files that other processes may not write: locks, and the file beside an output while it is made.

use crate::error::CliError;
use crate::files::named;
use crate::terminal;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// A file that is locked against other processes while it is open.
#[derive(Debug)]
pub(crate) enum Lock {
    /// The file with its content, and true if the file is new and empty.
    Held(File, bool),
    /// As `Held`, on a file system without locks.
    Unlocked(File, bool),
    /// Another process has the file.
    Busy,
}

/// Opens a file for reading and writing, or makes it, and locks it. A link is not followed: in a folder of many people it may lead anywhere.
///
/// # Errors
/// Fails if the operating system does, or if the path leads to a link or to anything but a regular file.
pub(crate) fn locked(path: &Path) -> Result<Lock, Error> {
    loop {
        let (file, new) = match OpenOptions::new().read(true).write(true).create_new(true).open(path) {
            Ok(file) => (file, true),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => match existing(path) {
                Ok(file) => (file, false),
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                Err(error) => return Err(error),
            },
            Err(error) => return Err(error),
        };
        match file.try_lock() {
            // Another process may have removed the file between the two calls: the lock then belongs to a file without a name.
            Ok(()) if !is_at(&file, path) => {}
            Ok(()) => return Ok(Lock::Held(file, new)),
            Err(TryLockError::WouldBlock) => return Ok(Lock::Busy),
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                return Ok(Lock::Unlocked(file, new));
            }
            Err(TryLockError::Error(error)) => return Err(error),
        }
    }
}

/// Makes a new locked file in place of the old one, unless another process has that. The old file is removed and not emptied: a link may
/// have led to it.
///
/// # Errors
/// Those of the operating system.
pub(crate) fn replaced(path: &Path) -> Result<Lock, Error> {
    loop {
        match locked(path) {
            Ok(Lock::Held(_, false) | Lock::Unlocked(_, false)) => std::fs::remove_file(path)?,
            Err(_) if path.is_symlink() => std::fs::remove_file(path)?,
            other => return other,
        }
    }
}

fn existing(path: &Path) -> Result<File, Error> {
    let mut options = OpenOptions::new();
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags((OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed());
    }
    let refused = |problem| Error::new(ErrorKind::InvalidInput, problem);
    match options.read(true).write(true).open(path) {
        Ok(file) if file.metadata()?.is_file() => Ok(file),
        Ok(_) => Err(refused("the path is not a regular file")),
        Err(_) if path.is_symlink() => {
            Err(refused("the path is a symbolic link, which is not followed; remove the link"))
        }
        Err(error) => Err(error),
    }
}

/// Whether the path still leads to the open file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let found = [file.metadata(), path.symlink_metadata()].map(|found| found.map(|m| (m.dev(), m.ino())).ok());
    found[0].is_some() && found[0] == found[1]
}

/// An open file cannot be removed here.
#[cfg(not(unix))]
fn is_at(_file: &File, _path: &Path) -> bool {
    true
}

/// The file `OUT.part` beside an output, which keeps rows until the output can be written whole. It is locked while this value lives, so
/// that two processes never write into it.
#[derive(Debug)]
pub(crate) struct PartFile {
    path: PathBuf,
    file: File,
    new: bool,
}

impl PartFile {
    /// The name of the file beside `out`.
    pub(crate) fn path_of(out: &Path) -> PathBuf {
        let mut name = out.file_name().unwrap_or_default().to_owned();
        name.push(".part");
        out.with_file_name(name)
    }

    /// Opens the file beside `out` with its content, or makes an empty one.
    ///
    /// # Errors
    /// [`CliError::Busy`] if another process has the file, [`CliError::Write`] if it cannot be made.
    pub(crate) fn lock(out: &Path) -> Result<Self, CliError> {
        let path = Self::path_of(out);
        match locked(&path).map_err(|source| CliError::Write { path: path.clone(), source })? {
            Lock::Held(file, new) => Ok(Self { path, file, new }),
            Lock::Busy => Err(CliError::Busy { path, out: out.to_owned() }),
            Lock::Unlocked(file, new) => {
                let told = "the file system has no locks; no other process may write";
                terminal::say("warning", &format!("{}: {told} {}", path.display(), out.display()));
                Ok(Self { path, file, new })
            }
        }
    }

    /// Whether this value made the file.
    pub(crate) fn is_new(&self) -> bool {
        self.new
    }

    /// The size of the file (bytes).
    pub(crate) fn len(&self) -> Result<u64, CliError> {
        Ok(self.file.metadata().map_err(|source| self.failed(source))?.len())
    }

    /// The path of the file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The file, open for reading and writing.
    pub(crate) fn file(&self) -> &File {
        &self.file
    }

    /// An error of the file.
    pub(crate) fn failed(&self, source: Error) -> CliError {
        CliError::Write { path: self.path.clone(), source }
    }

    /// Gives the file the name of the output.
    pub(crate) fn becomes(self, out: &Path, overwrite: bool) -> Result<(), CliError> {
        let failed = |source| CliError::Write { path: out.to_owned(), source };
        let path = TempPath::try_from_path(&self.path).map_err(failed)?;
        named(path, &self.file, out, overwrite).map_err(|error| {
            // The rows stay where they are.
            let _ = error.path.keep();
            if error.error.kind() == ErrorKind::AlreadyExists {
                CliError::Exists { path: out.to_owned() }
            } else {
                failed(error.error)
            }
        })
    }

    /// Removes the file. If that fails, the file that is left does no harm.
    pub(crate) fn remove(self) {
        let _ = std::fs::remove_file(&self.path);
    }
}
