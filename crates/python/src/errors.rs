use cli::Refusal;
use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::PyException;

create_exception!(noslip, NoslipError, PyException, "Why noslip did not do what it was asked.");
create_exception!(
    noslip,
    RequestError,
    NoslipError,
    "The request was wrong: a scene, a method or a value that is not accepted."
);
create_exception!(noslip, ComputationError, NoslipError, "The computation failed, or no step meets a tolerance.");
create_exception!(noslip, BusyError, RequestError, "Another process writes the same output.");

/// The exception of what was not computed.
pub(crate) fn raised(Refusal { message, request }: Refusal) -> PyErr {
    if request { RequestError::new_err(message) } else { ComputationError::new_err(message) }
}
