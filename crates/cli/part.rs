use crate::error::CliError;
use crate::files::named;
use crate::lock::{Lock, locked};
use crate::terminal;
use std::fs::File;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

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
