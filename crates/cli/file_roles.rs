//! Which files a command reads, and which it will write: no file may have two of these roles.

use crate::error::CliError;
use crate::files::{new_of, place};
use crate::lock::PartFile;
use crate::provenance::metadata_of;
use std::path::{Path, PathBuf};

/// Every file of a command.
#[derive(Debug)]
pub(crate) struct FileRoles {
    read: Vec<PathBuf>,
    /// Each file with the flag that names it, or that names the file beside it.
    written: Vec<(String, PathBuf)>,
}

impl FileRoles {
    /// The files of a command on the scene or sweep `name`, with all files that it names.
    pub(crate) fn of(name: &str) -> Self {
        Self { read: scene::files_of(name).iter().map(|path| place(path)).collect(), written: Vec::new() }
    }

    /// One more file that is read.
    pub(crate) fn reads(mut self, path: &Path) -> Self {
        self.read.push(place(path));
        self
    }

    /// A file that is written whole, under its temporary name first.
    pub(crate) fn writes(self, flag: &str, path: Option<&Path>) -> Self {
        path.into_iter().fold(self, |roles, path| roles.named(flag, path, &[path.to_owned()]))
    }

    /// A file of rows, which are in a spool until the end, with what made them beside it.
    pub(crate) fn rows(self, flag: &str, path: Option<&Path>) -> Self {
        let path = path.filter(|path| *path != Path::new("-"));
        path.into_iter().fold(self, |roles, path| {
            roles.named(flag, path, &[path.to_owned(), PartFile::path_of(path), metadata_of(path)])
        })
    }

    fn named(mut self, flag: &str, path: &Path, files: &[PathBuf]) -> Self {
        let flag = format!("{flag} {}", path.display());
        let all = files.iter().flat_map(|file| [place(file), place(&new_of(file))]);
        self.written.extend(all.map(|file| (flag.clone(), file)));
        self
    }

    /// Refuses a file that is read and written, or written twice, even if files may be overwritten.
    pub(crate) fn check(&self) -> Result<(), CliError> {
        for (number, (flag, file)) in self.written.iter().enumerate() {
            if self.read.contains(file) {
                let problem = format!("{flag}: the command reads {}; choose another name", file.display());
                return Err(CliError::Request(problem));
            }
            let before = self.written[..number].iter().find(|(other, written)| other != flag && written == file);
            if let Some((other, _)) = before {
                let problem = format!("{flag}: {other} writes {} too; choose another name", file.display());
                return Err(CliError::Request(problem));
            }
        }
        Ok(())
    }
}
