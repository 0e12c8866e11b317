use crate::supervise::{Supervised, supervised};
use cli::Called;
use pyo3::prelude::*;
use std::ffi::OsString;

/// The exit code, standard output and standard error of a command, and the exception that ended it.
type Output = (u8, String, String, Option<Py<PyAny>>);

/// Does a command of the program `noslip`, with these arguments.
#[pyfunction]
#[pyo3(signature = (arguments, progress=None))]
pub(crate) fn command(
    py: Python<'_>,
    arguments: Vec<OsString>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Output> {
    let Supervised { value, ended } = supervised(py, progress, |caller| cli::call(arguments, caller))?;
    let Called { code, out, err } = value;
    Ok((code, out, err, ended.map(|error| error.into_value(py).into_any())))
}
