use crate::error::CliError;
use crate::terminal;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

/// The file `OUT.part` beside an output, in which rows are kept until the output can be written whole. It is locked as long as this
/// value lives, so that two processes never write into one.
#[derive(Debug)]
pub(crate) struct Part {
    path: PathBuf,
    file: File,
}

impl Part {
    /// The name of the file beside `out`.
    pub(crate) fn path_of(out: &Path) -> PathBuf {
        let mut name = out.file_name().unwrap_or_default().to_owned();
        name.push(".part");
        out.with_file_name(name)
    }

    /// Opens the file beside `out` with what is in it, or makes an empty one.
    ///
    /// # Errors
    /// [`CliError::Busy`] where another process has it, [`CliError::Write`] where it cannot be made.
    pub(crate) fn lock(out: &Path) -> Result<Self, CliError> {
        let path = Self::path_of(out);
        let failed = |source| CliError::Write { path: path.clone(), source };
        loop {
            let mut options = OpenOptions::new();
            let file = options.read(true).write(true).create(true).truncate(false).open(&path).map_err(failed)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(CliError::Busy { path, out: out.to_owned() }),
                Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                    let told = "the file system has no locks; no other process may write";
                    terminal::say("warning", &format!("{}: {told} {}", path.display(), out.display()));
                }
                Err(TryLockError::Error(error)) => return Err(failed(error)),
            }
            // A process that was done may have removed the file between the two calls: the lock is then that of a file without a name.
            if is_at(&file, &path) {
                return Ok(Self { path, file });
            }
        }
    }

    /// Where the file is.
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

    /// Removes the file. Should that fail a file is left that does no harm.
    pub(crate) fn remove(self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Whether the path still leads to the open file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let [open, found] = [file.metadata(), path.metadata()].map(|metadata| metadata.map(|m| (m.dev(), m.ino())).ok());
    open.is_some() && open == found
}

/// An open file cannot be removed here.
#[cfg(not(unix))]
fn is_at(_file: &File, _path: &Path) -> bool {
    true
}
