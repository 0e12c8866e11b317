//! The Python package of noslip: scenes, runs in memory as NumPy arrays, and the commands of the program.
//!
//! What a user of Python sees is in `python/noslip`; this library gives it numbers.

mod commands;
mod errors;
mod scenes;
mod sensitivities;
mod supervise;

use pyo3::prelude::*;

/// The native part of the package `noslip`.
#[pymodule]
mod _noslip {
    use pyo3::exceptions::PyImportError;
    use pyo3::prelude::*;

    /// A library for another machine would end the interpreter at the first instruction that is not there.
    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        cli::wrong_processor().map_or(Ok(()), |problem| Err(PyImportError::new_err(problem)))
    }

    #[pymodule_export]
    use crate::commands::{arguments, command, plan};
    #[pymodule_export]
    use crate::errors::{BusyError, ComputationError, NoslipError, RequestError};
    #[pymodule_export]
    use crate::scenes::{Scene, bundled, methods};
    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "the name that Python has for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
