use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::Path;

/// A file that no other process has, as long as it is open.
#[derive(Debug)]
pub(crate) enum Lock {
    /// The file, with what was in it, or empty.
    Held(File),
    /// The same on a file system that has no locks.
    Unlocked(File),
    /// Another process has it.
    Busy,
}

/// Opens a file for reading and writing, or makes it, and locks it.
///
/// # Errors
/// Those of the operating system.
pub(crate) fn locked(path: &Path) -> Result<Lock, Error> {
    loop {
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        match file.try_lock() {
            // A process that was done may have removed the file between the two calls: the lock is then that of a file without a name.
            Ok(()) if !is_at(&file, path) => {}
            Ok(()) => return Ok(Lock::Held(file)),
            Err(TryLockError::WouldBlock) => return Ok(Lock::Busy),
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                return Ok(Lock::Unlocked(file));
            }
            Err(TryLockError::Error(error)) => return Err(error),
        }
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
