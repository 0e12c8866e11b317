use crate::error::CliError;
use std::io::{BufWriter, Error, Write};
use std::path::Path;

/// Refuses a file that is there already, unless it may be overwritten.
pub(crate) fn refuse_existing(path: &Path, overwrite: bool) -> Result<(), CliError> {
    if !overwrite && path.symlink_metadata().is_ok() {
        return Err(CliError::Exists { path: path.to_owned() });
    }
    Ok(())
}

/// Writes a file that appears whole or not at all: under another name beside it, renamed when it is complete.
pub(crate) fn write_whole(
    path: &Path,
    overwrite: bool,
    content: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> Result<(), Error>,
) -> Result<(), CliError> {
    refuse_existing(path, overwrite)?;
    let failed = |source| CliError::Write { path: path.to_owned(), source };
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if path.is_dir() {
        return Err(failed(Error::from(std::io::ErrorKind::IsADirectory)));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".noslip-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The usual rights of a new file, not the private ones of a temporary file.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    {
        let mut buffer = BufWriter::new(file.as_file_mut());
        content(&mut buffer).and_then(|()| buffer.flush()).map_err(failed)?;
    }
    file.as_file().sync_all().map_err(failed)?;
    let kept = if overwrite { file.persist(path) } else { file.persist_noclobber(path) };
    kept.map(|_| ()).map_err(|error| failed(error.error))
}
