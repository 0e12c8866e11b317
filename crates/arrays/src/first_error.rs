use std::io::{Error, ErrorKind, Result, Seek, SeekFrom, Write};

/// A writer that keeps its first error to itself and from then on pretends to write.
///
/// An archive that cannot be written tries to finish itself when it is dropped, and prints on standard error that it
/// cannot. Over this writer it ends in peace, and [`into_result`](Self::into_result) tells what happened.
#[derive(Debug)]
pub(crate) struct FirstError<W> {
    inner: W,
    position: u64,
    error: Option<Error>,
}

impl<W> FirstError<W> {
    /// Over a writer that stands at its beginning.
    pub(crate) fn new(inner: W) -> Self {
        Self { inner, position: 0, error: None }
    }

    /// The first error, if there was one.
    pub(crate) fn into_result(self) -> Result<()> {
        self.error.map_or(Ok(()), Err)
    }

    /// What `operation` gives, or `pretended` once something has failed.
    fn attempt<T>(&mut self, pretended: T, operation: impl FnOnce(&mut W) -> Result<T>) -> Result<T> {
        if self.error.is_some() {
            return Ok(pretended);
        }
        match operation(&mut self.inner) {
            Err(error) if error.kind() != ErrorKind::Interrupted => {
                self.error = Some(error);
                Ok(pretended)
            }
            outcome => outcome,
        }
    }
}

impl<W: Write> Write for FirstError<W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let written = self.attempt(bytes.len(), |inner| inner.write(bytes))?;
        self.position += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> Result<()> {
        self.attempt((), Write::flush)
    }
}

impl<W: Seek> Seek for FirstError<W> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let pretended = match to {
            SeekFrom::Start(position) => position,
            SeekFrom::Current(offset) => self.position.saturating_add_signed(offset),
            SeekFrom::End(_) => self.position,
        };
        self.position = self.attempt(pretended, |inner| inner.seek(to))?;
        Ok(self.position)
    }
}
