use crate::errors::{BusyError, in_python, raised};
use crate::supervise::{Supervised, supervised};
use cli::{CommandOutput, SweepPlan};
use pyo3::prelude::*;
use std::ffi::OsString;

/// The exit code, standard output and standard error of a command, and the exception that ended it.
type Output = (u8, String, String, Option<Py<PyAny>>);

/// The beginning of the names of the files of a sweep, the number of its members, and the names of its parts.
type Planned = (String, u64, Vec<String>);

/// Does a command of the program `noslip`, with these arguments.
#[pyfunction]
#[pyo3(signature = (arguments, progress=None))]
pub(crate) fn command(
    py: Python<'_>,
    arguments: Vec<OsString>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Output> {
    let Supervised { value, ended } = supervised(py, progress, |caller| cli::call(arguments, caller))?;
    let CommandOutput { code, out, err, busy } = value;
    let ended = if busy { Some(BusyError::new_err(err.trim().to_owned())) } else { ended };
    let err = if code == 0 { err } else { in_python(&err) };
    Ok((code, out, err, ended.map(|error| error.into_value(py).into_any())))
}

/// The flags of a command, as arguments.
#[pyfunction]
pub(crate) fn arguments(command: &str) -> Vec<String> {
    cli::flags(command).into_iter().map(|flag| flag.replace('-', "_")).collect()
}

/// The parts that the sweep in a file is computed in.
#[pyfunction]
pub(crate) fn plan(sweep: &str, parts: u64) -> PyResult<Planned> {
    let SweepPlan { stem, members, parts } = cli::plan(sweep, parts).map_err(raised)?;
    Ok((stem, members, parts))
}
